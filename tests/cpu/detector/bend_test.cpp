// SPDX-License-Identifier: MIT
// A mesh whose vertices come elsewhere is the mesh that is newly made of them.
#include "cpu/scenes/bent_meshes.h"
#include "cpu/scenes/needle_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "host/scene/scene_impl.h"
#include "support/host_meters.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

TEST(BentMesh, CountsAndOutputsAreThoseOfAMeshMadeAfresh) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    std::vector<cpu::Detector> detectors;
    for (const Projection projection : {Projection::View, Projection::DominantAxis, Projection::Certified}) {
        detectors.push_back(
            take(cpu::Detector::create({.threads = 2,
                                        .projection = projection,
                                        .outputs = {.triangles = true, .contacts = true, .bounds = true}})));
    }
    std::size_t hits = 0;
    for (std::size_t round = 0; round < randomCases(200, 10); ++round) {
        const RandomScene scene = makeRandomScene(random, 4);
        const cpu::Volume volume = take(cpu::Volume::create(scene.volume.view()));
        const cpu::TransferFunction function = take(cpu::TransferFunction::create(scene.transferFunction()));
        MeshData data = scene.mesh;
        cpu::Mesh mesh = take(cpu::Mesh::create(data.view()));
        for (int step = 0; step < 2; ++step) {
            data.positions = bent(random, data, bendSize(scene.volume.grid));
            ASSERT_TRUE(mesh.update(data.positions).ok());
            const cpu::Mesh fresh = take(cpu::Mesh::create(data.view()));
            EXPECT_EQ(mesh.facts().degenerate, fresh.facts().degenerate);
            EXPECT_EQ(mesh.facts().bounds.lo, fresh.facts().bounds.lo);
            EXPECT_EQ(mesh.facts().bounds.hi, fresh.facts().bounds.hi);
            for (cpu::Detector& detector : detectors) {
                const auto answerOf = [&](const cpu::Mesh& of) {
                    const cpu::BatchItem item{&of, &volume, &function, scene.poses};
                    return take(detector.detect({{&item, 1}, scene.view, scene.threshold}));
                };
                const BatchAnswer answer = answerOf(mesh);
                ASSERT_EQ(everythingOf(answer), everythingOf(answerOf(fresh)))
                    << toString(answer.pairs.front().projection);
                for (const PairAnswer& pair : answer.pairs) {
                    hits += pair.hit ? 1U : 0U;
                }
            }
        }
    }
    EXPECT_GT(hits, 20U) << "hardly anything touched";
}

TEST(BentMesh, ClearancesHoldForBoth) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    constexpr double kTolerance = 0.01;
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 2, .tolerance = kTolerance}));
    std::size_t apart = 0;
    for (std::size_t round = 0; round < randomCases(600, 10); ++round) {
        const RandomScene scene = makeRandomScene(random, 4);
        const cpu::Volume volume = take(cpu::Volume::create(scene.volume.view()));
        const cpu::TransferFunction function = take(cpu::TransferFunction::create(scene.transferFunction()));
        MeshData data = scene.mesh;
        cpu::Mesh mesh = take(cpu::Mesh::create(data.view()));
        data.positions = bent(random, data, bendSize(scene.volume.grid));
        ASSERT_TRUE(mesh.update(data.positions).ok());
        const cpu::Mesh fresh = take(cpu::Mesh::create(data.view()));
        const cpu::BatchItem items[] = {{&mesh, &volume, &function, scene.poses},
                                        {&fresh, &volume, &function, scene.poses}};
        const DistanceAnswer answer = take(meter.measure({.items = items, .view = {}, .threshold = scene.threshold}));
        for (std::size_t i = 0; i < scene.poses.size(); ++i) {
            const Bounds& a = answer.pairs[i].bounds;
            const Bounds& b = answer.pairs[i + scene.poses.size()].bounds;
            // Both hold the truth, so that they overlap.
            EXPECT_LE(a.lower, b.upper);
            EXPECT_LE(b.lower, a.upper);
            EXPECT_EQ(a.upper == 0, b.upper == 0);
            apart += a.lower > 0 && std::isfinite(a.upper) ? 1U : 0U;
        }
    }
    EXPECT_GT(apart, 10U);
}

using BentNeedle = NeedleFixture;

TEST_F(BentNeedle, TouchesWhereItsTipComes) {
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create());
    const auto clearance = [&] {
        const cpu::BatchItem one = item();
        return take(meter.measure({.items = {&one, 1}, .view = {}})).pairs.front().bounds;
    };
    const double straight = clearance().lower;
    EXPECT_GT(straight, 3);
    for (const double by : {1.0, 2.5, -1.0, 0.0}) {
        ASSERT_TRUE(mesh_.update(deflected(by)).ok());
        // Somewhat less where the tip is the nearest: it is narrower than the shaft.
        EXPECT_NEAR(clearance().lower, straight - std::max(by, 0.0), 0.3) << by;
    }
    ASSERT_TRUE(mesh_.update(deflected(straight + 1)).ok());
    EXPECT_EQ(clearance().upper, 0);
    ASSERT_TRUE(mesh_.update(data_.positions).ok());
    EXPECT_EQ(clearance().lower, straight);
}

TEST_F(BentNeedle, ATrackerSeesIt) {
    cpu::DistanceTracker tracker = take(cpu::DistanceTracker::create());
    EXPECT_FALSE(take(tracker.track(item())).hit);
    EXPECT_FALSE(take(tracker.track(item())).searched);
    ASSERT_TRUE(mesh_.update(deflected(6)).ok());
    EXPECT_TRUE(take(tracker.track(item())).hit);
}

TEST_F(BentNeedle, WhatIsRefusedLeavesItAsItWas) {
    const auto text = [](const Result<void>& updated) { return updated.ok() ? "" : updated.error().text; };
    const std::uint64_t before = mesh_.impl().id;
    const std::vector<float> x = mesh_.impl().x;
    std::vector<double> positions = deflected(6);
    positions.pop_back();
    EXPECT_THAT(text(mesh_.update(positions)), HasSubstr("coordinates, the mesh has"));
    EXPECT_THAT(text(mesh_.update({})), HasSubstr("0 coordinates"));
    positions = deflected(6);
    positions[7] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(text(mesh_.update(positions)), HasSubstr("vertex 2 of the mesh has a coordinate that is NaN"));
    EXPECT_EQ(mesh_.impl().id, before);
    EXPECT_EQ(mesh_.impl().x, x);
}

TEST(BentMesh, BoxesAreThoseOfItsClustersAgain) {
    const MeshData data = take(makeEllipsoid(3000));
    const cpu::Mesh fresh = take(cpu::Mesh::create(data.view()));
    cpu::Mesh mesh = take(cpu::Mesh::create(data.view()));
    std::vector<double> away = data.positions;
    for (double& coordinate : away) {
        coordinate = 3 * coordinate + 50;
    }
    ASSERT_TRUE(mesh.update(away).ok());
    EXPECT_NE(mesh.impl().centreX, fresh.impl().centreX);
    ASSERT_TRUE(mesh.update(data.positions).ok());
    EXPECT_EQ(mesh.impl().centreX, fresh.impl().centreX);
    EXPECT_EQ(mesh.impl().halfZ, fresh.impl().halfZ);
    EXPECT_EQ(mesh.impl().y, fresh.impl().y);
    ASSERT_EQ(mesh.impl().tree.levels(), fresh.impl().tree.levels());
    for (std::uint32_t level = 0; level < fresh.impl().tree.levels(); ++level) {
        const auto expected = fresh.impl().tree.boxes(level);
        const auto boxes = mesh.impl().tree.boxes(level);
        ASSERT_EQ(boxes.size(), expected.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            EXPECT_EQ(boxes[i].lo, expected[i].lo);
            EXPECT_EQ(boxes[i].hi, expected[i].hi);
        }
    }
    EXPECT_EQ(mesh.impl().indices(), data.indices);
}

} // namespace
} // namespace voxtact::test
