// SPDX-License-Identifier: MIT
// Clearances, margins and motions through the C interface: the C++ interface's answers, every member of them.
#include "both_interfaces.h"
#include "support/contact_scenes.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <cmath>
#include <iostream>

namespace voxtact::test {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;

Owned<vxt_clearances> newClearances() {
    return made<vxt_clearances>(vxt_clearances_destroy, [](auto out) { return vxt_clearances_create(out); });
}

Owned<vxt_motions> newMotions() {
    return made<vxt_motions>(vxt_motions_destroy, [](auto out) { return vxt_motions_create(out); });
}

vxt_clearance_view viewOf(const vxt_clearances& clearances) {
    vxt_clearance_view view = vxt_clearance_view_init();
    need(vxt_clearances_get(&clearances, &view));
    return view;
}

vxt_motion_view viewOf(const vxt_motions& motions) {
    vxt_motion_view view = vxt_motion_view_init();
    need(vxt_motions_get(&motions, &view));
    return view;
}

void expectSame(const vxt_pair_clearance& c, const PairClearance& cpp) {
    EXPECT_EQ(c.lo, cpp.bounds.lo);
    EXPECT_EQ(c.hi, cpp.bounds.hi);
    EXPECT_EQ(c.pair, cpp.pair);
    EXPECT_EQ(c.item, cpp.item);
    EXPECT_EQ(c.pose, cpp.pose);
    EXPECT_STREQ(vxt_clearance_end_name(c.end), toString(cpp.end));
    EXPECT_EQ(c.has_closest != 0, cpp.closest.has_value());
    const ClosestPoints closest = cpp.closest.value_or(ClosestPoints());
    EXPECT_EQ(c.triangle, closest.triangle);
    EXPECT_THAT(c.mesh, ElementsAreArray(closest.mesh));
    EXPECT_THAT(c.volume, ElementsAreArray(closest.volume));
    EXPECT_THAT(c.per_translation, ElementsAreArray(closest.perTranslation));
    EXPECT_THAT(c.per_rotation, ElementsAreArray(closest.perRotation));
}

void expectSame(const vxt_label_clearance& c, const LabelClearance& cpp) {
    EXPECT_EQ(c.lo, cpp.bounds.lo);
    EXPECT_EQ(c.hi, cpp.bounds.hi);
    EXPECT_EQ(c.pair, cpp.pair);
    EXPECT_EQ(c.item, cpp.item);
    EXPECT_EQ(c.pose, cpp.pose);
    EXPECT_EQ(c.label, cpp.label);
    EXPECT_STREQ(vxt_clearance_end_name(c.end), toString(cpp.end));
    EXPECT_EQ(c.reserved, 0U);
}

void expectSame(const vxt_segment_motion& c, const SegmentMotion& cpp) {
    EXPECT_EQ(c.free_until, cpp.freeUntil);
    EXPECT_EQ(c.segment, cpp.segment);
    EXPECT_EQ(c.item, cpp.item);
    EXPECT_EQ(c.pose, cpp.pose);
    EXPECT_EQ(c.possible != 0, cpp.possible);
    EXPECT_STREQ(vxt_motion_end_name(c.end), toString(cpp.end));
    EXPECT_EQ(c.touches != 0, cpp.touch.has_value());
    const MotionTouch touch = cpp.touch.value_or(MotionTouch());
    EXPECT_EQ(c.touch_at, touch.at);
    EXPECT_EQ(c.triangle, touch.triangle);
    EXPECT_THAT(c.world_from_object, ElementsAreArray(touch.world_from_object));
    EXPECT_THAT(c.position, ElementsAreArray(touch.position));
    EXPECT_EQ(c.reserved, 0U);
}

/// Both interfaces' engines.
struct Engines {
    Engines() {
        clearanceDesc.tolerance = 0.1;
        clearanceDesc.maximum = 20;
        clearanceDesc.resolution = 1.0 / 8;
        clearanceDesc.threads = 1;
        motionDesc.resolution = 0.1;
        motionDesc.touch_resolution = 1.0 / 8;
        motionDesc.interpolation = VXT_INTERPOLATION_SLERP;
        motionDesc.threads = 1;
    }

    vxt_host_clearance_desc clearanceDesc = vxt_host_clearance_desc_init();
    vxt_host_motion_desc motionDesc = vxt_host_motion_desc_init();
    cpu::ClearanceMeter meter =
        take(cpu::ClearanceMeter::create({.threads = 1, .tolerance = 0.1, .maximum = 20, .resolution = 1.0 / 8}));
    cpu::MotionChecker checker = take(cpu::MotionChecker::create(
        {.threads = 1, .interpolation = Interpolation::Slerp, .resolution = 0.1, .touchResolution = 1.0 / 8}));
    Owned<vxt_host_clearance_meter> cMeter{nullptr, vxt_host_clearance_meter_destroy};
    Owned<vxt_host_motion_checker> cChecker{nullptr, vxt_host_motion_checker_destroy};

    void start() {
        cMeter = made<vxt_host_clearance_meter>(vxt_host_clearance_meter_destroy, [&](auto out) {
            return vxt_host_clearance_meter_create(&clearanceDesc, out);
        });
        cChecker = made<vxt_host_motion_checker>(vxt_host_motion_checker_destroy, [&](auto out) {
            return vxt_host_motion_checker_create(&motionDesc, out);
        });
        EXPECT_EQ(vxt_host_clearance_meter_threads(cMeter.get()), 1U);
        EXPECT_EQ(vxt_host_motion_checker_threads(cChecker.get()), 1U);
    }
};

/// How often each was seen.
struct Tally {
    std::size_t apart = 0;
    std::size_t labelled = 0;
    std::size_t touching = 0;
};

void compare(const BothInterfaces& both, const RandomScene& scene, Engines& engines, Tally& tally) {
    const cpu::BatchItem item{&both.mesh, &both.volume, &both.function, scene.poses, &both.labels};
    const cpu::Batch batch{std::span(&item, 1), scene.view, scene.threshold};
    BothInterfaces::CBatch c;
    both.fill(c, scene);

    const Owned<vxt_clearances> clearances = newClearances();
    need(vxt_host_clearance_meter_measure(engines.cMeter.get(), &c.batch, clearances.get()));
    const std::vector<PairClearance> pairs = take(engines.meter.measure(batch)).pairs;
    vxt_clearance_view near = viewOf(*clearances);
    ASSERT_EQ(near.pair_count, pairs.size());
    EXPECT_EQ(near.label_count, 0U);
    EXPECT_GE(near.wall_milliseconds, 0);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        expectSame(near.pairs[i], pairs[i]);
        tally.apart += pairs[i].bounds.lo > 0 ? 1 : 0;
    }

    const std::vector<std::int32_t> asked{both.labels.values.back(), 0, 12345};
    need(vxt_host_clearance_meter_measure_labels(engines.cMeter.get(), &c.batch, asked.data(), asked.size(),
                                                 clearances.get()));
    const std::vector<LabelClearance> labels = take(engines.meter.measureLabels(batch, asked)).labels;
    near = viewOf(*clearances);
    ASSERT_EQ(near.label_count, labels.size());
    EXPECT_EQ(near.pair_count, 0U);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        expectSame(near.labels[i], labels[i]);
        tally.labelled += std::isfinite(labels[i].bounds.hi) ? 1 : 0;
    }

    const Owned<vxt_answer> answer = newAnswer();
    need(vxt_host_clearance_meter_within(engines.cMeter.get(), &c.batch, 1.5, answer.get()));
    EXPECT_EQ(wholeDifferenceOf(answerOf(*answer), take(engines.meter.within(batch, 1.5))), "");
    need(vxt_host_motion_checker_around(engines.cChecker.get(), &c.batch, 1.5, 3, answer.get()));
    EXPECT_EQ(wholeDifferenceOf(answerOf(*answer), take(engines.checker.around(batch, {1.5, 3}))), "");

    const Owned<vxt_motions> motions = newMotions();
    need(vxt_host_motion_checker_check(engines.cChecker.get(), &c.batch, motions.get()));
    const std::vector<SegmentMotion> segments = take(engines.checker.check(batch)).segments;
    const vxt_motion_view way = viewOf(*motions);
    ASSERT_EQ(way.segment_count, segments.size());
    ASSERT_EQ(way.segment_count, scene.poses.size() - 1);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        expectSame(way.segments[i], segments[i]);
        tally.touching += segments[i].touch ? 1 : 0;
    }
}

TEST(CNear, ALabelIsMeasuredAtAnyOpacityWhereThatIsAskedFor) {
    // A label that is not opaque anywhere: 3 mm beside the mesh, or infinitely far.
    RandomScene scene;
    scene.volume = makeBytes(millimetreGrid(16), [](auto...) { return 0.0; });
    scene.points = {{100, 0}, {200, 1}};
    scene.domain = {0, 255};
    scene.mesh = makeCube(0, 2);
    scene.poses = {identity()};
    const VolumeData labels = makeBytes(millimetreGrid(16), [](auto x, auto...) { return x >= 6 ? 4.0 : 0.0; });
    const BothInterfaces both(scene, labels);
    BothInterfaces::CBatch c;
    both.fill(c, scene);
    const std::int32_t label = 4;
    const auto distance = [&](std::uint32_t atAnyOpacity) {
        vxt_host_clearance_desc desc = vxt_host_clearance_desc_init();
        desc.labels_at_any_opacity = atAnyOpacity;
        const auto meter = made<vxt_host_clearance_meter>(
            vxt_host_clearance_meter_destroy, [&](auto out) { return vxt_host_clearance_meter_create(&desc, out); });
        const Owned<vxt_clearances> clearances = newClearances();
        need(vxt_host_clearance_meter_measure_labels(meter.get(), &c.batch, &label, 1, clearances.get()));
        const vxt_clearance_view view = viewOf(*clearances);
        EXPECT_EQ(view.label_count, 1U);
        return view.labels[0].hi;
    };
    EXPECT_EQ(distance(0), std::numeric_limits<double>::infinity());
    // Voxel 6 begins at 5.5, the cube ends at 2.
    EXPECT_NEAR(distance(1), 3.5, 0.01);
}

/// Poses of a random scene may be of different scales, which no motion joins.
void makeRigid(RandomScene& scene, std::mt19937_64& random) {
    for (Mat4& pose : scene.poses) {
        pose = randomMotion(random);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            pose[12 + axis] *= 0.3;
        }
    }
}

TEST(CNear, AnswersAsTheCppInterfaceDoes) {
    std::mt19937_64 random(testSeed());
    Engines engines;
    engines.start();
    Tally tally;
    const auto isSeen = [&tally] { return tally.apart > 0 && tally.labelled > 0 && tally.touching > 0; };
    // Of ten scenes of some seeds none touches.
    for (int round = 0; (round < 10 || (round < 300 && !isSeen())) && !HasFatalFailure(); ++round) {
        const std::uint64_t seed = random();
        SCOPED_TRACE("scene " + std::to_string(seed));
        std::mt19937_64 local(seed);
        RandomScene scene = makeRandomScene(local, 4);
        makeRigid(scene, local);
        const VolumeData labels =
            makeBytes(scene.volume.grid, [](auto x, auto y, auto z) { return (x / 3 + y / 3 + z / 3) % 3; });
        compare(BothInterfaces(scene, labels), scene, engines, tally);
    }
    std::cout << tally.apart << " apart, " << tally.labelled << " with a label, " << tally.touching << " touch\n";
    EXPECT_GT(tally.apart, 0U);
    EXPECT_GT(tally.labelled, 0U);
    EXPECT_GT(tally.touching, 0U);
}

TEST(CNear, ATrackerFollowsAsTheCppInterfacesDoes) {
    // Down a random way through random voxels, in steps so small that most answers need no look.
    std::mt19937_64 random(testSeed());
    RandomScene scene = makeRandomScene(random, 2);
    makeRigid(scene, random);
    const VolumeData labels = makeBytes(scene.volume.grid, [](auto...) { return 1.0; });
    const BothInterfaces both(scene, labels);
    vxt_host_tracker_desc desc = vxt_host_tracker_desc_init();
    desc.maximum = 50;
    desc.resolution = 1.0 / 8;
    const auto tracker = made<vxt_host_clearance_tracker>(
        vxt_host_clearance_tracker_destroy, [&](auto out) { return vxt_host_clearance_tracker_create(&desc, out); });
    cpu::ClearanceTracker cpp = take(cpu::ClearanceTracker::create({.maximum = 50, .resolution = 1.0 / 8}));
    BothInterfaces::CBatch c;
    both.fill(c, scene);
    std::size_t looks = 0;
    constexpr int kSteps = 2000;
    for (int step = 0; step <= kSteps; ++step) {
        const Mat4 pose = take(poseBetween(scene.poses[0], scene.poses[1], static_cast<double>(step) / kSteps));
        c.item.world_from_object = pose.data();
        c.item.pose_count = 1;
        vxt_tracked_clearance found = vxt_tracked_clearance_init();
        need(vxt_host_clearance_tracker_track(tracker.get(), &c.item, scene.threshold, &found));
        const TrackedClearance expected =
            take(cpp.track({&both.mesh, &both.volume, &both.function, std::span(&pose, 1)}, scene.threshold));
        ASSERT_EQ(found.lo, expected.bounds.lo);
        ASSERT_EQ(found.hi, expected.bounds.hi);
        ASSERT_EQ(found.hit != 0, expected.hit);
        ASSERT_EQ(found.possible != 0, expected.possible);
        ASSERT_EQ(found.searched != 0, expected.searched);
        looks += found.searched;
    }
    EXPECT_GT(looks, 0U);
    vxt_tracked_clearance found = vxt_tracked_clearance_init();
    c.item.pose_count = 2;
    c.item.world_from_object = scene.poses.data()->data();
    EXPECT_EQ(vxt_host_clearance_tracker_track(tracker.get(), &c.item, 0.1, &found), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("one pose"));
    EXPECT_EQ(vxt_host_clearance_tracker_track(nullptr, &c.item, 0.1, &found), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_host_clearance_tracker_track(tracker.get(), nullptr, 0.1, &found), VXT_ERROR_INVALID_ARGUMENT);
}

TEST(CNear, APoseOnTheWayIsTheCppInterfaces) {
    std::mt19937_64 random(testSeed());
    const Mat4 from = randomMotion(random);
    const Mat4 to = randomMotion(random);
    const Vec3 centre{1, 2, 3};
    Mat4 pose{};
    need(vxt_pose_between(from.data(), to.data(), 0.3, VXT_INTERPOLATION_SCREW, nullptr, pose.data()));
    EXPECT_EQ(pose, take(poseBetween(from, to, 0.3)));
    need(vxt_pose_between(from.data(), to.data(), 0.3, VXT_INTERPOLATION_SLERP, centre.data(), pose.data()));
    EXPECT_EQ(pose, take(poseBetween(from, to, 0.3, Interpolation::Slerp, centre)));
    const auto refused = [&](const double* a, const double* b, double at, const double* c, double* out) {
        EXPECT_EQ(vxt_pose_between(a, b, at, VXT_INTERPOLATION_SLERP, c, out), VXT_ERROR_INVALID_ARGUMENT);
        return std::string(vxt_last_error(nullptr));
    };
    EXPECT_EQ(refused(nullptr, to.data(), 0, centre.data(), pose.data()), "from is null");
    EXPECT_EQ(refused(from.data(), nullptr, 0, centre.data(), pose.data()), "to is null");
    EXPECT_EQ(refused(from.data(), to.data(), 0, nullptr, pose.data()), "centre is null");
    EXPECT_EQ(refused(from.data(), to.data(), 0, centre.data(), nullptr), "world_from_object is null");
    EXPECT_EQ(refused(from.data(), to.data(), 2, centre.data(), pose.data()), "the parameter 2 is outside of 0 to 1");
    for (const int none : {-1, 2, 77}) {
        EXPECT_EQ(
            vxt_pose_between(from.data(), to.data(), 0.3, static_cast<vxt_interpolation>(none), nullptr, pose.data()),
            VXT_ERROR_INVALID_ARGUMENT);
        EXPECT_EQ(std::string(vxt_last_error(nullptr)),
                  "there is no interpolation number " + std::to_string(static_cast<std::uint32_t>(none)));
    }
    EXPECT_STREQ(vxt_interpolation_name(VXT_INTERPOLATION_SLERP), "slerp");
}

TEST(CNear, RefusesNullAndWhatTheCppInterfaceRefuses) {
    const auto text = [](vxt_result result) {
        EXPECT_EQ(result, VXT_ERROR_INVALID_ARGUMENT);
        return std::string(vxt_last_error(nullptr));
    };
    vxt_host_clearance_desc clearance = vxt_host_clearance_desc_init();
    clearance.tolerance = 0;
    vxt_host_clearance_meter* meter = nullptr;
    EXPECT_THAT(text(vxt_host_clearance_meter_create(&clearance, &meter)), HasSubstr("the tolerance 0 mm"));
    EXPECT_EQ(meter, nullptr);
    vxt_host_motion_desc motion = vxt_host_motion_desc_init();
    motion.interpolation = static_cast<vxt_interpolation>(9);
    vxt_host_motion_checker* checker = nullptr;
    EXPECT_THAT(text(vxt_host_motion_checker_create(&motion, &checker)), HasSubstr("interpolation"));
    EXPECT_EQ(text(vxt_host_clearance_meter_create(nullptr, nullptr)).find('\n'), std::string::npos);

    Engines engines;
    engines.start();
    const Owned<vxt_clearances> clearances = newClearances();
    const Owned<vxt_motions> motions = newMotions();
    const Owned<vxt_answer> answer = newAnswer();
    const vxt_host_batch batch = vxt_host_batch_init();
    vxt_host_clearance_meter* by = engines.cMeter.get();
    vxt_host_motion_checker* on = engines.cChecker.get();
    EXPECT_EQ(text(vxt_host_clearance_meter_measure(nullptr, &batch, clearances.get())), "meter is null");
    EXPECT_EQ(text(vxt_host_clearance_meter_measure(by, nullptr, clearances.get())), "batch is null");
    EXPECT_EQ(text(vxt_host_clearance_meter_measure(by, &batch, nullptr)), "clearances is null");
    EXPECT_EQ(text(vxt_host_clearance_meter_measure_labels(by, &batch, nullptr, 1, clearances.get())),
              "labels is null");
    EXPECT_EQ(text(vxt_host_clearance_meter_within(by, &batch, 1, nullptr)), "answer is null");
    EXPECT_THAT(text(vxt_host_clearance_meter_within(by, &batch, -1, answer.get())), HasSubstr("margin"));
    EXPECT_EQ(text(vxt_host_motion_checker_check(nullptr, &batch, motions.get())), "checker is null");
    EXPECT_EQ(text(vxt_host_motion_checker_check(on, &batch, nullptr)), "motions is null");
    EXPECT_THAT(text(vxt_host_motion_checker_around(on, &batch, -1, 0, answer.get())), HasSubstr("distance"));
    EXPECT_EQ(text(vxt_clearances_get(clearances.get(), nullptr)), "view is null");
    EXPECT_EQ(text(vxt_motions_get(nullptr, nullptr)), "motions is null");
    EXPECT_EQ(vxt_host_clearance_meter_threads(nullptr), 0U);
    EXPECT_EQ(vxt_host_motion_checker_threads(nullptr), 0U);
    // Nothing to do is done.
    need(vxt_host_clearance_meter_measure(by, &batch, clearances.get()));
    EXPECT_EQ(viewOf(*clearances).pair_count, 0U);
    need(vxt_host_motion_checker_check(on, &batch, motions.get()));
    EXPECT_EQ(viewOf(*motions).segment_count, 0U);
}

} // namespace
} // namespace voxtact::test
