// SPDX-License-Identifier: MIT
// Every allocation of a call fails once, on whichever thread it is: the call says so, throws nothing, and the next one
// gives the answer that there would have been. The program has an operator new of its own for it.
#include "both_interfaces.h"
#include "failing_memory.h"
#include "memory_sweep.h"
#include "support/scenes.h"
#include "voxtact/voxtact_vulkan.h"

#include <gmock/gmock.h>

#include <iostream>

namespace voxtact::test {
namespace {

/// A pose that touches and one that does not, of a mesh of a few triangles.
class Memory : public testing::Test {
  protected:
    Memory() { both_.fill(c_, scene_); }
    static RandomScene makeScene() {
        RandomScene scene;
        scene.volume = makeBytes(millimetreGrid(16),
                                 [](auto x, auto y, auto z) { return (x + y + z) % 5 < 2 && x < 8 ? 255.0 : 0.0; });
        scene.points = {{100, 0}, {200, 1}};
        scene.domain = {0, 255};
        scene.mesh = makeCube(0, 3);
        scene.poses = {translation({2.3, 2.1, 4.2}), translation({11.2, 4.1, 4.3})};
        scene.view = {framingCamera(scene.volume.grid, 64, 64), 64, 64};
        return scene;
    }

    RandomScene scene_ = makeScene();
    VolumeData labelImage_ = makeBytes(millimetreGrid(16), [](auto x, auto...) { return x < 4 ? 1.0 : 3.0; });
    BothInterfaces both_{scene_, labelImage_};
    BothInterfaces::CBatch c_;
};

TEST_F(Memory, OfWhatAScenesPartsAreMadeOf) {
    const vxt_volume_view volume = cVolume(scene_.volume);
    expectTightCreation<vxt_host_volume>("volume", vxt_host_volume_destroy,
                                         [&](auto out) { return vxt_host_volume_create(&volume, out); });
    const vxt_volume_view labels = cVolume(labelImage_);
    expectTightCreation<vxt_labels>("labels", vxt_labels_destroy,
                                    [&](auto out) { return vxt_labels_create(&labels, out); });
    const vxt_mesh_view mesh = cMesh(scene_.mesh);
    expectTightCreation<vxt_host_mesh>("mesh", vxt_host_mesh_destroy,
                                       [&](auto out) { return vxt_host_mesh_create(&mesh, out); });
    const std::size_t vertices = scene_.mesh.positions.size() / 3;
    expectTight(
        "bending a mesh",
        [&] { return vxt_host_mesh_update(both_.cMeshHandle.get(), scene_.mesh.positions.data(), vertices); }, [] {});
    const std::vector<vxt_control_point> points = cPoints(scene_.points);
    const vxt_transfer_function_desc function = cFunction(points, scene_.domain, 256);
    expectTightCreation<vxt_host_transfer_function>(
        "transfer function", vxt_host_transfer_function_destroy,
        [&](auto out) { return vxt_host_transfer_function_create(&function, out); });
    expectTightCreation<vxt_mesh_data>("builtin mesh", vxt_mesh_data_destroy,
                                       [&](auto out) { return vxt_builtin_mesh("needle", out); });
    expectTightCreation<vxt_volume_data>("builtin volume", vxt_volume_data_destroy,
                                         [&](auto out) { return vxt_builtin_volume("sphere:4", out); });
}

TEST_F(Memory, OfHandlesAndSmallThings) {
    expectTightCreation<vxt_answer>("answer", vxt_answer_destroy, [](auto out) { return vxt_answer_create(out); });
    expectTightCreation<vxt_clearances>("clearances", vxt_clearances_destroy,
                                        [](auto out) { return vxt_clearances_create(out); });
    expectTightCreation<vxt_cancel>("cancel", vxt_cancel_destroy, [](auto out) { return vxt_cancel_create(out); });
    expectTightCreation<vxt_host_detector>("detector", vxt_host_detector_destroy, [](auto out) {
        vxt_host_detector_desc desc = vxt_host_detector_desc_init();
        desc.threads = 1;
        return vxt_host_detector_create(&desc, out);
    });
    expectTightCreation<vxt_control_points>("opacity", vxt_control_points_destroy,
                                            [](auto out) { return vxt_parse_opacity("40:0,80:1", out); });
    const vxt_box boxes[] = {{{0, 0, 0}, {2, 2, 2}}, {{1, 1, 1}, {3, 3, 3}}};
    expectTightCreation<vxt_box_pairs>("box pairs", vxt_box_pairs_destroy,
                                       [&](auto out) { return vxt_overlapping_pairs(boxes, 2, nullptr, 0, out); });
    const double from[] = {0, 8, 8};
    const double to[] = {15, 8, 8};
    std::int32_t found[2] = {};
    std::size_t count = 0;
    expectTight(
        "labels along a line",
        [&] {
            count = 0;
            return vxt_labels_along(both_.cLabels.get(), from, to, found, 2, &count);
        },
        [&] { EXPECT_EQ(count, 2U); });
    const vxt_context_desc nothing = vxt_context_desc_init();
    vxt_report* report = nullptr;
    expectTight(
        "report",
        [&] {
            vxt_report_destroy(report);
            return vxt_check(&nothing, &report);
        },
        [&] { EXPECT_NE(report, nullptr); });
    vxt_report_destroy(report);
}

TEST_F(Memory, OfDetections) {
    for (const vxt_projection projection :
         {VXT_PROJECTION_CONSERVATIVE, VXT_PROJECTION_VIEW, VXT_PROJECTION_DOMINANT_AXIS}) {
        for (const std::uint32_t threads : {1U, 3U}) {
            vxt_host_detector_desc desc = vxt_host_detector_desc_init();
            desc.threads = threads;
            desc.projection = projection;
            desc.outputs = VXT_OUTPUT_CONTACTS | VXT_OUTPUT_TRIANGLES | VXT_OUTPUT_BOUNDS | VXT_OUTPUT_LABELS;
            const auto detector = made<vxt_host_detector>(
                vxt_host_detector_destroy, [&](auto out) { return vxt_host_detector_create(&desc, out); });
            const BatchAnswer expected = both_.byC(*detector, scene_);
            ASSERT_TRUE(expected.pairs[0].hit);
            const Owned<vxt_answer> answer = newAnswer();
            expectTight(
                vxt_projection_name(projection),
                [&] { return vxt_host_detector_detect(detector.get(), &c_.batch, answer.get()); },
                [&] { EXPECT_EQ(wholeDifferenceOf(answerOf(*answer), expected), ""); });
        }
    }
}

TEST_F(Memory, OfClearances) {
    for (const std::uint32_t threads : {1U, 3U}) {
        vxt_host_clearance_desc desc = vxt_host_clearance_desc_init();
        desc.threads = threads;
        desc.tolerance = 0.1;
        vxt_host_clearance_meter* meter = nullptr;
        const Owned<vxt_clearances> out =
            made<vxt_clearances>(vxt_clearances_destroy, [](auto o) { return vxt_clearances_create(o); });
        const std::int32_t asked[] = {1, 3};
        double expected[2] = {};
        const auto measured = [&](bool toLabels) {
            vxt_clearance_view view = vxt_clearance_view_init();
            need(vxt_clearances_get(out.get(), &view));
            return toLabels ? view.labels[1].hi : view.pairs[1].hi;
        };
        // Of an engine that knows the volume, and of one that does not.
        for (const bool known : {true, false}) {
            for (const bool toLabels : {false, true}) {
                const auto ask = [&] {
                    return toLabels ? vxt_host_clearance_meter_measure_labels(meter, &c_.batch, asked, 2, out.get())
                                    : vxt_host_clearance_meter_measure(meter, &c_.batch, out.get());
                };
                const auto fresh = [&] {
                    vxt_host_clearance_meter_destroy(meter);
                    return vxt_host_clearance_meter_create(&desc, &meter);
                };
                need(fresh());
                need(ask());
                expected[toLabels ? 1 : 0] = measured(toLabels);
                EXPECT_GT(expected[0], 0);
                expectTight(
                    toLabels ? "clearance to labels" : "clearance",
                    [&] {
                        const vxt_result ready = known ? VXT_OK : fresh();
                        return ready == VXT_OK ? ask() : ready;
                    },
                    [&] { EXPECT_EQ(measured(toLabels), expected[toLabels ? 1 : 0]); });
            }
        }
        const Owned<vxt_answer> answer = newAnswer();
        expectTight(
            "margin", [&] { return vxt_host_clearance_meter_within(meter, &c_.batch, 1, answer.get()); },
            [&] { EXPECT_TRUE(answerOf(*answer).pairs[0].hit); });
        vxt_host_clearance_meter_destroy(meter);
    }
}

TEST_F(Memory, OfAreas) {
    expectTightCreation<vxt_areas>("areas", vxt_areas_destroy, [](auto out) { return vxt_areas_create(out); });
    for (const std::uint32_t threads : {1U, 3U}) {
        vxt_host_area_desc desc = vxt_host_area_desc_init();
        desc.threads = threads;
        desc.tolerance = 0.05;
        vxt_host_area_meter* meter = nullptr;
        const Owned<vxt_areas> out = made<vxt_areas>(vxt_areas_destroy, [](auto o) { return vxt_areas_create(o); });
        const std::int32_t asked[] = {1, 3};
        for (const char* const what : {"area", "area by label", "area by triangle"}) {
            if (threads > 1 && std::string_view(what) == "area") {
                continue; // what it needs, that by triangle needs, too
            }
            const bool byLabel = std::string_view(what) == "area by label";
            const bool byTriangle = std::string_view(what) == "area by triangle";
            const auto ask = [&] {
                vxt_host_area_meter_destroy(meter);
                const vxt_result ready = vxt_host_area_meter_create(&desc, &meter);
                return ready != VXT_OK ? ready
                       : byLabel       ? vxt_host_area_meter_measure_labels(meter, &c_.batch, asked, 2, out.get())
                       : byTriangle    ? vxt_host_area_meter_measure_triangles(meter, &c_.batch, out.get())
                                       : vxt_host_area_meter_measure(meter, &c_.batch, out.get());
            };
            const auto measured = [&] {
                vxt_area_view view = vxt_area_view_init();
                need(vxt_areas_get(out.get(), &view));
                return byLabel ? view.labels[1].hi : byTriangle ? view.triangles[0].hi : view.pairs[0].hi;
            };
            need(ask());
            const double expected = measured();
            EXPECT_TRUE(byLabel || expected > 0);
            expectTight(what, ask, [&] { EXPECT_EQ(measured(), expected); });
        }
        vxt_host_area_meter_destroy(meter);
    }
}

TEST_F(Memory, AMeterThatNeverHadItsMemoryGetsItInTheNextCall) {
    vxt_host_clearance_desc desc = vxt_host_clearance_desc_init();
    desc.threads = 1;
    const Owned<vxt_clearances> out =
        made<vxt_clearances>(vxt_clearances_destroy, [](auto o) { return vxt_clearances_create(o); });
    std::uint64_t failures = 1;
    for (std::int64_t number = 0; failures > 0; ++number) {
        const Owned<vxt_host_clearance_meter> meter = made<vxt_host_clearance_meter>(
            vxt_host_clearance_meter_destroy, [&](auto o) { return vxt_host_clearance_meter_create(&desc, o); });
        FailingMemory memory(number, false);
        const vxt_result first = vxt_host_clearance_meter_measure(meter.get(), &c_.batch, out.get());
        memory.end();
        failures = memory.failures();
        EXPECT_TRUE(first == VXT_OK || failures > 0) << first;
        need(vxt_host_clearance_meter_measure(meter.get(), &c_.batch, out.get()));
        vxt_clearance_view view = vxt_clearance_view_init();
        need(vxt_clearances_get(out.get(), &view));
        EXPECT_GT(view.pairs[1].hi, 0) << "allocation " << number;
    }
}

TEST_F(Memory, OfMotionsAndTrackers) {
    vxt_host_motion_desc desc = vxt_host_motion_desc_init();
    desc.threads = 2;
    desc.resolution = 0.5;
    const auto checker = made<vxt_host_motion_checker>(
        vxt_host_motion_checker_destroy, [&](auto out) { return vxt_host_motion_checker_create(&desc, out); });
    const auto motions = made<vxt_motions>(vxt_motions_destroy, [](auto out) { return vxt_motions_create(out); });
    expectTight(
        "motion", [&] { return vxt_host_motion_checker_check(checker.get(), &c_.batch, motions.get()); },
        [&] {
            vxt_motion_view view = vxt_motion_view_init();
            need(vxt_motions_get(motions.get(), &view));
            EXPECT_EQ(view.segments[0].touches, 1U);
        });
    const Owned<vxt_answer> answer = newAnswer();
    expectTight(
        "pose tolerance",
        [&] { return vxt_host_motion_checker_around(checker.get(), &c_.batch, 0.2, 1, answer.get()); },
        [&] { EXPECT_TRUE(answerOf(*answer).pairs[0].hit); });
    vxt_host_clearance_tracker* tracker = nullptr;
    c_.item.world_from_object = scene_.poses[1].data();
    c_.item.pose_count = 1;
    vxt_tracked_clearance tracked = vxt_tracked_clearance_init();
    expectTight(
        "tracker",
        [&] {
            vxt_host_clearance_tracker_destroy(tracker);
            const vxt_result ready = vxt_host_clearance_tracker_create(nullptr, &tracker);
            return ready == VXT_OK ? vxt_host_clearance_tracker_track(tracker, &c_.item, scene_.threshold, &tracked)
                                   : ready;
        },
        [&] { EXPECT_EQ(tracked.hit, 0U); });
    vxt_host_clearance_tracker_destroy(tracker);
}

TEST_F(Memory, ATrackerWhoseLookFailedKnowsNothingOfTheSceneThatItWasAbout) {
    const VolumeData empty = makeBytes(millimetreGrid(16), [](auto...) { return 0.0; });
    const auto nothing = made<vxt_host_volume>(vxt_host_volume_destroy, [&](auto out) {
        const vxt_volume_view view = cVolume(empty);
        return vxt_host_volume_create(&view, out);
    });
    c_.item.pose_count = 1;
    std::size_t failed = 0;
    for (std::int64_t number = 0;; ++number) {
        const auto tracker = made<vxt_host_clearance_tracker>(vxt_host_clearance_tracker_destroy, [](auto out) {
            return vxt_host_clearance_tracker_create(nullptr, out);
        });
        vxt_tracked_clearance found = vxt_tracked_clearance_init();
        const auto track = [&](const vxt_host_volume* volume) {
            c_.item.volume = volume;
            return vxt_host_clearance_tracker_track(tracker.get(), &c_.item, scene_.threshold, &found);
        };
        need(track(nothing.get()));
        ASSERT_EQ(found.hit, 0U);
        FailingMemory memory(number, false);
        const vxt_result result = track(both_.cVolumeHandle.get());
        memory.end();
        need(track(both_.cVolumeHandle.get()));
        ASSERT_EQ(found.hit, 1U) << "after allocation " << number << " failed";
        failed += result == VXT_OK ? 0 : 1;
        if (memory.failures() == 0) {
            break;
        }
    }
    EXPECT_GT(failed, 0U);
}

TEST_F(Memory, OfPlans) {
    vxt_plan_obstacle obstacle = vxt_plan_obstacle_init();
    obstacle.volume = both_.cVolumeHandle.get();
    obstacle.transfer_function = both_.cFunctionHandle.get();
    obstacle.threshold = 0.5;
    vxt_plan_task task = vxt_plan_task_init();
    task.obstacles = &obstacle;
    task.obstacle_count = 1;
    task.entries = 12;
    task.entry_radius = 4;
    task.target[0] = 12;
    task.target[1] = task.target[2] = 8;
    vxt_host_planner_desc desc = vxt_host_planner_desc_init();
    desc.threads = 2;
    const auto planner =
        made<vxt_host_planner>(vxt_host_planner_destroy, [&](auto out) { return vxt_host_planner_create(&desc, out); });
    const auto plan = made<vxt_plan>(vxt_plan_destroy, [](auto out) { return vxt_plan_create(out); });
    expectTight(
        "plan", [&] { return vxt_host_planner_plan(planner.get(), &task, plan.get()); },
        [&] {
            vxt_plan_view view = vxt_plan_view_init();
            need(vxt_plan_get(plan.get(), &view));
            EXPECT_EQ(view.path_count, 12U);
        });
}

} // namespace
} // namespace voxtact::test
