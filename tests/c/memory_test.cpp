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
    BothInterfaces::CPairs c_;
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
    expectTightCreation<vxt_cancel>("cancel", vxt_cancel_destroy, [](auto out) { return vxt_cancel_create(out); });
    expectTightCreation<vxt_host_engine>("engine", vxt_host_engine_destroy,
                                         [](auto out) { return vxt_host_engine_create(1, out); });
    vxt_fact fact = sized<vxt_fact>();
    need(vxt_fact_get(0, &fact)); // its texts are made once
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
    const vxt_context_desc nothing = sized<vxt_context_desc>();
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

/// The bytes of every column but the times.
std::vector<std::byte> contentOf(const vxt_answer& answer) {
    std::vector<std::byte> all;
    vxt_column column = sized<vxt_column>();
    for (std::size_t i = 0; i < vxt_answer_columns(&answer); ++i) {
        need(vxt_answer_column(&answer, i, &column));
        if (std::string_view(column.unit) == "ms") {
            continue;
        }
        const std::size_t bytes =
            column.elements * (column.type == VXT_TYPE_DOUBLE || column.type == VXT_TYPE_UINT64 ? 8U : 4U);
        for (std::size_t row = 0; row < column.rows; ++row) {
            const auto* from = static_cast<const std::byte*>(column.data) + row * column.stride;
            all.insert(all.end(), from, from + bytes);
        }
    }
    return all;
}

class QuestionMemory : public Memory {
  protected:
    /// Of an engine that knows the volume, and of one that does not.
    void expectTightAnswer(const std::string& what, std::uint32_t threads, const auto& ask,
                           std::vector<bool> known = {true, false}) {
        for (const bool isKnown : known) {
            Owned<vxt_host_engine> engine = newEngine(threads);
            const Owned<vxt_answer> answer = newAnswer();
            const auto call = [&] {
                if (!isKnown) {
                    vxt_host_engine* fresh = nullptr;
                    const vxt_result result = vxt_host_engine_create(threads, &fresh);
                    if (result != VXT_OK) {
                        return result;
                    }
                    engine.reset(fresh);
                }
                return ask(engine.get(), answer.get());
            };
            need(call());
            const std::vector<std::byte> expected = contentOf(*answer);
            EXPECT_FALSE(expected.empty());
            expectTight((what + (isKnown ? "" : " of a new engine")).c_str(), call,
                        [&] { EXPECT_EQ(contentOf(*answer), expected); });
        }
    }
    void expectTightAnswer(const std::string& what, const char* question, const Settings& settings,
                           const std::vector<bool>& known = {true, false}) {
        for (const std::uint32_t threads : {1U, 3U}) {
            expectTightAnswer(
                what, threads,
                [&](vxt_host_engine* engine, vxt_answer* answer) {
                    return askC(engine, question, settings, &c_.pairs, answer);
                },
                known);
        }
    }
    static constexpr std::int32_t kLabels[] = {1, 3};
};

TEST_F(QuestionMemory, OfCounts) {
    for (const char* const projection : {"certified", "view", "dominant-axis"}) {
        expectTightAnswer(
            projection, "count",
            {{"projection", projection}, {"contacts", 1}, {"triangles", 1}, {"bounds", 1}, {"labels", 1}});
    }
}

TEST_F(QuestionMemory, OfTouches) {
    expectTightAnswer("touch", "touch", {{"margin", 1}, {"witness", 1}});
    expectTightAnswer("touch at uncertain poses", "touch", {{"uncertainty_distance", 0.2}, {"uncertainty_angle", 1}},
                      {true}); // a new engine allocates thousands of times
}

TEST_F(QuestionMemory, OfDistances) {
    expectTightAnswer("distance", "distance", {{"tolerance", 0.1}});
    expectTightAnswer("distance to labels", "distance", {{"tolerance", 0.1}, {"labels", kLabels}});
}

TEST_F(QuestionMemory, OfAreas) {
    expectTightAnswer("area by triangle", "area", {{"tolerance", 0.05}, {"triangles", 1}});
    expectTightAnswer("area in labels", "area", {{"tolerance", 0.05}, {"labels", kLabels}});
}

TEST_F(QuestionMemory, OfMotions) {
    expectTightAnswer("motion", "motion", {{"resolution", 0.5}});
}

TEST_F(QuestionMemory, OfPlans) {
    vxt_obstacle obstacle{};
    obstacle.volume = both_.cVolumeHandle.get();
    obstacle.transfer_function = both_.cFunctionHandle.get();
    obstacle.opacity_threshold = 0.5;
    vxt_plan question = sized<vxt_plan>();
    question.obstacles = &obstacle;
    question.obstacle_count = 1;
    question.entries = 12;
    question.entry_radius = 4;
    question.target[0] = 12;
    question.target[1] = question.target[2] = 8;
    expectTightAnswer("plan", 2, [&](vxt_host_engine* engine, vxt_answer* answer) {
        return vxt_ask_plan(engine, &question, answer);
    });
}

TEST_F(QuestionMemory, AnEngineThatNeverHadItsMemoryGetsItInTheNextCall) {
    const Owned<vxt_answer> answer = newAnswer();
    std::uint64_t failures = 1;
    for (std::int64_t number = 0; failures > 0; ++number) {
        const Owned<vxt_host_engine> engine = newEngine();
        FailingMemory memory(number, false);
        const vxt_result first = askC(engine.get(), "distance", {}, &c_.pairs, answer.get());
        memory.end();
        failures = memory.failures();
        EXPECT_TRUE(first == VXT_OK || failures > 0) << first;
        need(askC(engine.get(), "distance", {}, &c_.pairs, answer.get()));
        EXPECT_GT(readColumn<double>(*answer, "pairs", "upper").at(1), 0) << "allocation " << number;
    }
}

TEST_F(Memory, OfTrackers) {
    vxt_tracker* tracker = nullptr;
    c_.item.world_from_object = scene_.poses[1].data();
    c_.item.pose_count = 1;
    vxt_tracked tracked = sized<vxt_tracked>();
    expectTight(
        "tracker",
        [&] {
            vxt_tracker_destroy(tracker);
            const vxt_result ready = vxt_tracker_create(0, 0, 0, &tracker);
            return ready == VXT_OK ? vxt_tracker_track(tracker, &c_.item, scene_.threshold, &tracked) : ready;
        },
        [&] { EXPECT_EQ(tracked.touch, 0U); });
    vxt_tracker_destroy(tracker);
}

TEST_F(Memory, ATrackerWhoseSearchFailedKnowsNothingOfTheSceneThatItWasAbout) {
    const VolumeData empty = makeBytes(millimetreGrid(16), [](auto...) { return 0.0; });
    const auto nothing = made(vxt_host_volume_destroy, vxt_host_volume_create, at(cVolume(empty)));
    c_.item.pose_count = 1;
    std::size_t failed = 0;
    for (std::int64_t number = 0;; ++number) {
        const auto tracker = made(vxt_tracker_destroy, vxt_tracker_create, 0, 0, 0);
        vxt_tracked found = sized<vxt_tracked>();
        const auto track = [&](const vxt_host_volume* volume) {
            c_.item.volume = volume;
            return vxt_tracker_track(tracker.get(), &c_.item, scene_.threshold, &found);
        };
        need(track(nothing.get()));
        ASSERT_EQ(found.touch, 0U);
        FailingMemory memory(number, false);
        const vxt_result result = track(both_.cVolumeHandle.get());
        memory.end();
        need(track(both_.cVolumeHandle.get()));
        ASSERT_EQ(found.touch, 1U) << "after allocation " << number << " failed";
        failed += result == VXT_OK ? 0 : 1;
        if (memory.failures() == 0) {
            break;
        }
    }
    EXPECT_GT(failed, 0U);
}

} // namespace
} // namespace voxtact::test
