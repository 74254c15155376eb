// SPDX-License-Identifier: MIT
// A mesh under a hand: what a DistanceTracker says at every pose, against detectors and meters that know no history.
#include "cpu/scenes/certified_scenes.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "support/special.h"

#include <gmock/gmock.h>

#include <cmath>
#include <iostream>

namespace voxtact::test {
namespace {

/// Opaque where z is from 20 on: a floor at z = 20 under a mesh that comes from below.
VolumeData makeFloor() {
    Grid grid;
    grid.size = {32, 32, 32};
    return makeVolume<std::uint8_t>(grid, ScalarType::UInt8, [](auto, auto, auto z) { return z < 20 ? 0 : 255; });
}

struct Scene {
    Scene() : Scene(makeFloor(), makeRectangle({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0})) {}
    Scene(const VolumeData& image, const MeshData& data)
        : mesh(take(cpu::Mesh::create(data.view()))), volume(take(cpu::Volume::create(image.view()))),
          function(take(cpu::TransferFunction::create({points, {0, 255}, 256}))) {}

    [[nodiscard]] cpu::BatchItem at(const Mat4& pose) const { return {&mesh, &volume, &function, {&pose, 1}}; }

    std::vector<ControlPoint> points{{0, 0}, {255, 1}};
    cpu::Mesh mesh;
    cpu::Volume volume;
    cpu::TransferFunction function;
};

cpu::DistanceTracker makeTracker(const cpu::TrackerDesc& desc = {}) {
    return take(cpu::DistanceTracker::create(desc));
}

/// Of the floor at a threshold of a half: between voxel 19, which is 0, and voxel 20, which is 255.
constexpr double kFloor = 19.5;

TEST(Tracker, WhatIsFarIsNotLookedAtAgain) {
    const Scene scene;
    cpu::DistanceTracker tracker = makeTracker();
    int searches = 0;
    for (int tick = 0; tick <= 1000; ++tick) {
        const double z = 0.01 * tick;
        const Mat4 pose = translation({15, 15, z});
        const TrackedDistance found = take(tracker.track(scene.at(pose), 0.5));
        SCOPED_TRACE(z);
        EXPECT_FALSE(found.hit || found.possible);
        EXPECT_LE(found.bounds.lower, kFloor - z + 0.01);
        EXPECT_GE(found.bounds.upper, kFloor - z - 0.01);
        searches += found.searched ? 1 : 0;
    }
    // The first one goes as far as it must; the next, three quarters of that on, no farther than 32 moves.
    EXPECT_LE(searches, 2);
}

TEST(Tracker, WhatStandsStillIsLookedAtOnce) {
    const Scene scene;
    cpu::DistanceTracker tracker = makeTracker();
    const Mat4 pose = translation({15, 15, 19});
    EXPECT_TRUE(take(tracker.track(scene.at(pose), 0.5)).searched);
    const TrackedDistance again = take(tracker.track(scene.at(pose), 0.5));
    EXPECT_FALSE(again.searched);
    EXPECT_GT(again.bounds.lower, 0.3);
    EXPECT_LT(again.bounds.upper, 0.52);
}

TEST(Tracker, ItTouchesWhereADetectorSaysSo) {
    const Scene scene;
    cpu::DistanceTracker tracker = makeTracker();
    cpu::Detector detector =
        take(cpu::Detector::create({.threads = 1, .stopAtFirst = true, .projection = Projection::Certified}));
    int hits = 0;
    for (int tick = 0; tick < 400; ++tick) {
        const Mat4 pose = translation({15, 15, kFloor + 0.5 * std::sin(0.05 * tick)});
        const cpu::BatchItem item = scene.at(pose);
        const TrackedDistance found = take(tracker.track(item, 0.5));
        const PairAnswer wanted = take(detector.detect({std::span(&item, 1), {}, 0.5})).pairs[0];
        EXPECT_EQ(found.hit, wanted.hit) << tick;
        EXPECT_EQ(found.bounds.upper == 0, wanted.hit) << tick;
        hits += found.hit ? 1 : 0;
    }
    EXPECT_GT(hits, 100);
    EXPECT_LT(hits, 300);
}

/// Walks of all speeds in scenes of all kinds, turns included.
TEST(Tracker, IsNeverWrongOnRandomWalks) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    int searches = 0;
    int ticks = 0;
    for (int i = 0; i < 40; ++i) {
        const CertifiedCase c = makeCertifiedCase(seed, random());
        const Scene scene = [&] {
            Scene made(c.scene.volume, c.scene.mesh);
            made.function = take(cpu::TransferFunction::create({c.scene.points, c.scene.domain, c.scene.tableSize}));
            return made;
        }();
        cpu::DistanceTracker tracker = makeTracker();
        cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
        Mat4 pose = c.scene.world_from_object;
        const double step = std::pow(10, uniform(random, -3, 0));
        const Mat4 direction = randomRotation(random);
        for (int tick = 0; tick < 30; ++tick, ++ticks) {
            const double angle = 0.002 * tick;
            const Mat4 turn{std::cos(angle),
                            std::sin(angle),
                            0,
                            0,
                            -std::sin(angle),
                            std::cos(angle),
                            0,
                            0,
                            0,
                            0,
                            1,
                            0,
                            0,
                            0,
                            0,
                            1};
            pose = multiply(translation({step * direction[0], step * direction[1], step * direction[2]}),
                            multiply(pose, turn));
            const cpu::BatchItem item = scene.at(pose);
            const TrackedDistance found = take(tracker.track(item, c.scene.threshold));
            const PairDistance wanted = take(meter.measure({std::span(&item, 1), {}, c.scene.threshold})).pairs[0];
            SCOPED_TRACE("case " + std::to_string(i) + ", tick " + std::to_string(tick));
            searches += found.searched ? 1 : 0;
            // Both hold the truth.
            ASSERT_LE(found.bounds.lower, wanted.bounds.upper);
            ASSERT_GE(found.bounds.upper, wanted.bounds.lower);
            ASSERT_EQ(found.hit, wanted.bounds.upper == 0);
            if (!found.searched) {
                ASSERT_GT(found.bounds.lower, 0);
            }
        }
    }
    std::cout << searches << " searches in " << ticks << " ticks\n";
    EXPECT_LT(searches, ticks);
}

TEST(Tracker, ChangesAreSeenAtOnce) {
    Scene scene;
    cpu::DistanceTracker tracker = makeTracker();
    const Mat4 pose = translation({15, 15, 5});
    EXPECT_NEAR(take(tracker.track(scene.at(pose), 0.5)).bounds.upper, kFloor - 5, 0.01);
    EXPECT_FALSE(take(tracker.track(scene.at(pose), 0.5)).searched);

    // an edit
    ASSERT_TRUE(scene.volume.set(VoxelBox{{14, 14, 8}, {3, 3, 2}}, 255).ok());
    const TrackedDistance edited = take(tracker.track(scene.at(pose), 0.5));
    EXPECT_TRUE(edited.searched);
    EXPECT_NEAR(edited.bounds.upper, 2.5, 0.01);

    // a threshold: twice as near to the voxel that is opaque
    const TrackedDistance lower = take(tracker.track(scene.at(pose), 0.25));
    EXPECT_TRUE(lower.searched);
    EXPECT_NEAR(lower.bounds.upper, 2.25, 0.01);

    // a transfer function under which nothing is opaque
    scene.function = take(cpu::TransferFunction::create({std::vector<ControlPoint>{{0, 0}}, {0, 255}, 256}));
    const TrackedDistance nothing = take(tracker.track(scene.at(pose), 0.25));
    EXPECT_TRUE(nothing.searched);
    EXPECT_EQ(nothing.bounds.lower, kInfinity);
    EXPECT_FALSE(take(tracker.track(scene.at(translation({15, 15, 25})), 0.25)).searched);

    // a mesh, at the address of another
    Scene other;
    EXPECT_TRUE(take(tracker.track(other.at(pose), 0.5)).searched);
    const MeshData longer = makeRectangle({0, 0, 0}, {1, 0, 0}, {1, 0, 10}, {0, 0, 10});
    other.mesh = take(cpu::Mesh::create(longer.view()));
    const TrackedDistance nearer = take(tracker.track(other.at(pose), 0.5));
    EXPECT_TRUE(nearer.searched);
    EXPECT_NEAR(nearer.bounds.upper, kFloor - 15, 0.01);
}

TEST(Tracker, LooksNoFartherThanAsked) {
    const Scene scene;
    cpu::DistanceTracker tracker = makeTracker({.maximum = 2});
    const TrackedDistance found = take(tracker.track(scene.at(translation({15, 15, 5})), 0.5));
    EXPECT_TRUE(found.searched);
    EXPECT_GE(found.bounds.lower, 2);
    EXPECT_LE(found.bounds.lower, kFloor - 5);
}

TEST(Tracker, RefusesWhatCannotBe) {
    using testing::HasSubstr;
    using testing::StartsWith;
    for (const double maximum : {0.0, -1.0, std::nan("")}) {
        const auto refused = cpu::DistanceTracker::create({.maximum = maximum});
        ASSERT_FALSE(refused.ok());
        EXPECT_THAT(refused.error().text, HasSubstr("is not a number above 0 mm"));
    }
    EXPECT_FALSE(cpu::DistanceTracker::create({.maxSteps = 0}).ok());
    EXPECT_FALSE(cpu::DistanceTracker::create({.resolution = 2}).ok());

    const Scene scene;
    cpu::DistanceTracker tracker = makeTracker();
    const std::vector<Mat4> two(2, identity());
    const auto several = tracker.track({&scene.mesh, &scene.volume, &scene.function, two}, 0.5);
    ASSERT_FALSE(several.ok());
    EXPECT_THAT(several.error().text, HasSubstr("one pose at a time, not 2"));
    EXPECT_FALSE(tracker.track({&scene.mesh, &scene.volume, &scene.function, {}}, 0.5).ok());
    EXPECT_FALSE(tracker.track({nullptr, &scene.volume, &scene.function, std::span(two).first(1)}, 0.5).ok());
    Mat4 bad = identity();
    bad[13] = std::nan("");
    const auto notFinite = tracker.track(scene.at(bad), 0.5);
    ASSERT_FALSE(notFinite.ok());
    EXPECT_THAT(notFinite.error().text, StartsWith("the item, pose 0")) << "there is no batch";
    EXPECT_FALSE(tracker.track(scene.at(two[0]), 1.5).ok());
}

} // namespace
} // namespace voxtact::test
