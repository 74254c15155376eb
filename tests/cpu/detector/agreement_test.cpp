// SPDX-License-Identifier: MIT
// The engine against the reference, bit for bit: whatever it skips, and whatever instructions it uses.
#include "cpu/scenes/random_scene.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>
#include <hwy/targets.h>

namespace voxtact::test {
namespace {

std::vector<std::uint64_t> survivorsOf(const std::vector<cpu::ReferenceCounts>& counts) {
    std::vector<std::uint64_t> out;
    for (const cpu::ReferenceCounts& count : counts) {
        out.push_back(count.survivors);
    }
    return out;
}

std::vector<std::uint64_t> engineCounts(const RandomScene& scene, std::uint32_t threads, bool stopAtFirst = false,
                                        const Outputs& outputs = {}) {
    const cpu::Volume volume = std::move(cpu::Volume::create(scene.volume.view())).value();
    const cpu::TransferFunction function = std::move(cpu::TransferFunction::create(scene.transferFunction())).value();
    const cpu::Mesh mesh = std::move(cpu::Mesh::create(scene.mesh.view())).value();
    cpu::Detector detector =
        std::move(cpu::Detector::create({.threads = threads,
                                         .boundary = scene.rangeTest ? Boundary::Range : Boundary::Clamp,
                                         .stopAtFirst = stopAtFirst,
                                         .outputs = outputs}))
            .value();
    const cpu::BatchItem item{&mesh, &volume, &function, scene.poses};
    const Result<BatchAnswer> answer = detector.detect({std::span(&item, 1), scene.view, scene.threshold});
    EXPECT_TRUE(answer.ok()) << answer.error().text;
    std::vector<std::uint64_t> out;
    for (const PairAnswer& pair : answer->pairs) {
        EXPECT_EQ(pair.hit, pair.count > 0);
        out.push_back(pair.count);
    }
    return out;
}

struct PixelTally {
    std::size_t cases = 0;
    std::size_t hits = 0;
    std::uint64_t covered = 0;
    std::uint64_t survivors = 0;

    void add(const std::vector<cpu::ReferenceCounts>& counts) {
        for (const cpu::ReferenceCounts& count : counts) {
            ++cases;
            hits += count.survivors > 0 ? 1U : 0U;
            covered += count.covered;
            survivors += count.survivors;
        }
    }
};

/// Of so many scenes, drawn with random poses.
PixelTally expectTheReference(std::size_t rounds, std::size_t poses,
                              RandomScene (*draw)(std::mt19937_64& random, std::size_t poses)) {
    std::mt19937_64 random(testSeed());
    PixelTally tally;
    for (std::size_t round = 0; round < rounds && !testing::Test::HasFailure(); ++round) {
        const std::uint64_t seed = random();
        std::mt19937_64 local(seed);
        const RandomScene scene = draw(local, poses);
        const auto expected = scene.reference();
        tally.add(expected);
        EXPECT_EQ(engineCounts(scene, 1), survivorsOf(expected)) << "round " << round << ", scene " << seed;
    }
    std::cout << tally.cases << " pairs, " << tally.hits << " with a survivor, " << tally.covered << " fragments, "
              << tally.survivors << " survivors\n";
    return tally;
}

TEST(Agreement, RandomScenes) {
    const PixelTally tally = expectTheReference(randomCases(1500, 4), 4, makeRandomScene);
    EXPECT_GT(tally.hits, tally.cases / 10) << "a test that hits nothing proves nothing";
}

TEST(Agreement, TrianglesWithAFarCorner) {
    const PixelTally tally = expectTheReference(randomCases(20000, 40), 2, makeFarCornerScene);
    EXPECT_GT(tally.hits, tally.cases / 50) << "a test that hits nothing proves nothing";
}

/// However far away its corner is, a triangle that does not meet the box of the volume has no survivor.
TEST(Agreement, AFarCornerMakesNoSurvivors) {
    RandomScene scene;
    Grid grid;
    grid.size = {24, 30, 27};
    grid.spacing = {1.018961457930295, 1.8333917292845729, 1.8796871691628994};
    grid.origin = {1.6428317214741561, -14.131109706015359, -1.6457729707796318};
    scene.volume = makeBytes(grid, [](auto...) { return 255.0; });
    scene.points.assign(byteRamp().begin(), byteRamp().end());
    scene.domain = {0, 255};
    scene.view = {framingCamera(grid, 64, 48), 64, 48};
    scene.poses = {{0.44440840813124838, 0.8800755122344649, 0.16723713567116089, 0,     //
                    0.76475705014031925, -0.46993962673729506, 0.44079859514600273, 0,   //
                    0.46652740652927044, -0.067998823425532429, -0.88188907407327433, 0, //
                    12.358907631947554, 41.291716131544618, 35.013796723994872, 1}};
    scene.mesh.indices = {0, 1, 2};
    for (const float far : {2.07101407e22F, 2.07101407e16F, 2.07101407e13F, 2.07101407e10F, 2.07101407e7F}) {
        scene.mesh.positions = {-21.9121532F, 25.5159588F, 21.3404102F, 31.6302128F, -28.3482952F,
                                far,          28.22435F,   10.7610626F, -5.14233494F};
        EXPECT_EQ(engineCounts(scene, 1), std::vector<std::uint64_t>{0}) << far;
        EXPECT_EQ(engineCounts(scene, 1, true), std::vector<std::uint64_t>{0}) << far;
        EXPECT_EQ(survivorsOf(scene.reference()), std::vector<std::uint64_t>{0}) << far;
    }
}

/// Behind the volume, or before it, in a view so deep that nothing is clipped: what is interpolated between a far
/// corner and two that are hardly beyond may be in it.
TEST(Agreement, WhatIsBeyondTheVolumeHasNoSurvivors) {
    RandomScene scene;
    scene.volume = makeBytes(unitGrid(8, 8, 8), [](auto...) { return 255.0; });
    scene.points.assign(byteRamp().begin(), byteRamp().end());
    scene.domain = {0, 255};
    scene.view = flatView(0, 1, 64, 64);
    scene.view.clip_from_world[10] = 1e-10;
    scene.poses = {identity()};
    scene.mesh.indices = {0, 1, 2};
    const auto place = [](int pixel) { return (static_cast<float>(pixel) + 0.5F) / 64; };
    for (const int last : {60, 14}) { // large, and small
        // The edge between the near corners goes through the centres of pixels; either is a top edge of one view.
        for (const auto& [nearRow, farRow] : {std::pair(3, last), std::pair(last, 3)}) {
            for (float far = 100; far < 4e9F; far *= 1.7F) {
                for (const auto& [near, farthest] : {std::pair(1.01F, far), std::pair(-0.01F, -far)}) {
                    scene.mesh.positions = {place(3), place(farRow), farthest,       place(3), place(nearRow),
                                            near,     place(last),   place(nearRow), near};
                    EXPECT_EQ(engineCounts(scene, 1), std::vector<std::uint64_t>{0}) << last << ", " << farthest;
                    EXPECT_EQ(engineCounts(scene, 1, false, {.triangles = true}), std::vector<std::uint64_t>{0})
                        << last << ", " << farthest;
                    EXPECT_EQ(survivorsOf(scene.reference()), std::vector<std::uint64_t>{0})
                        << last << ", " << farthest;
                }
            }
        }
    }
}

TEST(Agreement, EveryInstructionSet) {
    std::mt19937_64 random(testSeed());
    const std::int64_t all = hwy::SupportedTargets();
    for (std::int64_t rest = all; rest != 0; rest &= rest - 1) {
        const std::int64_t target = rest & -rest;
        SCOPED_TRACE(hwy::TargetName(target));
        std::cout << hwy::TargetName(target) << "\n";
        hwy::SetSupportedTargetsForTest(target);
        for (int round = 0; round < 150; ++round) {
            const std::uint64_t seed = random();
            std::mt19937_64 local(seed);
            const RandomScene scene = makeRandomScene(local, 3);
            EXPECT_EQ(engineCounts(scene, 1), survivorsOf(scene.reference())) << "scene " << seed;
        }
    }
    hwy::SetSupportedTargetsForTest(0);
}

TEST(Agreement, ThreadsAndFirstHits) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 100; ++round) {
        const std::uint64_t seed = random();
        std::mt19937_64 local(seed);
        RandomScene scene = makeRandomScene(local, round % 2 == 0 ? 1 : 9);
        if (round % 4 == 0) {
            scene.mesh = makeEllipsoid(kEllipsoidTriangles).value();
        }
        const auto one = engineCounts(scene, 1);
        EXPECT_EQ(engineCounts(scene, 5), one) << "scene " << seed;
        const auto first = engineCounts(scene, 3, true);
        for (std::size_t i = 0; i < one.size(); ++i) {
            EXPECT_EQ(first[i], one[i] > 0 ? 1U : 0U) << "scene " << seed;
        }
    }
}

} // namespace
} // namespace voxtact::test
