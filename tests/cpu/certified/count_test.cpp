// SPDX-License-Identifier: MIT
// Fragments that are only counted are as many as those of which something is told.
#include "cpu/scenes/certified_scenes.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"

#include <hwy/targets.h>

#include <gtest/gtest.h>

#include <iostream>
#include <vector>

namespace voxtact::test {
namespace {

PairAnswer answerTo(const OracleScene& scene, bool triangles) {
    const oracle::OraclePair pair = scene.pair();
    const cpu::Mesh mesh = take(cpu::Mesh::create(pair.mesh));
    const cpu::Volume volume = take(cpu::Volume::create(pair.volume));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create(pair.transferFunction));
    cpu::DetectorDesc desc;
    desc.threads = 1;
    desc.projection = Projection::Conservative;
    desc.outputs.triangles = triangles;
    cpu::Detector detector = take(cpu::Detector::create(desc));
    const cpu::BatchItem item{&mesh, &volume, &function, {&pair.world_from_object, 1}};
    return take(detector.detect({{&item, 1}, {}, pair.threshold})).pairs.front();
}

void expectTheSame(const OracleScene& scene, std::uint64_t& counted) {
    const PairAnswer told = answerTo(scene, true);
    const PairAnswer bare = answerTo(scene, false);
    EXPECT_EQ(bare.count, told.count);
    EXPECT_EQ(bare.hit, told.hit);
    EXPECT_EQ(bare.possible, told.possible);
    EXPECT_EQ(bare.exactness, told.exactness);
    counted += bare.count;
}

TEST(CertifiedCount, IsThatOfTheFragmentsThatAreTold) {
    const std::uint64_t seed = testSeed();
    std::uint64_t counted = 0;
    for (std::uint64_t number = 0; number < randomCases(40000, 10) && !HasFailure(); ++number) {
        SCOPED_TRACE(number);
        expectTheSame(makeCertifiedCase(seed, number).scene, counted);
    }
    EXPECT_GT(counted, 1000U);
}

/// Most cells are opaque all over: a noise above the threshold with holes in it.
OracleScene drawnInside(std::mt19937_64& random) {
    Grid grid;
    for (std::uint32_t& size : grid.size) {
        size = 1 + static_cast<std::uint32_t>(below(random, 40));
    }
    OracleScene scene;
    scene.volume = makeVolume<std::uint8_t>(grid, ScalarType::UInt8, [&](auto...) {
        return chance(random, 0.003) ? 0 : 150 + static_cast<double>(below(random, 100));
    });
    const double size = std::pow(10, uniform(random, -1, 1.5));
    for (int triangle = 0; triangle < 20; ++triangle) {
        std::array<Vec3, 3> corners{};
        const Vec3 middle{uniform(random, -1, grid.size[0]), uniform(random, -1, grid.size[1]),
                          uniform(random, -1, grid.size[2])};
        for (Vec3& corner : corners) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                corner[axis] = middle[axis] + uniform(random, -size, size);
            }
        }
        addTriangle(scene.mesh, corners[0], corners[1], corners[2]);
    }
    return scene;
}

TEST(CertifiedCount, IsThatInsideOfWhatIsOpaque) {
    std::mt19937_64 random(testSeed());
    std::uint64_t counted = 0;
    for (int round = 0; round < 500 && !HasFailure(); ++round) {
        expectTheSame(drawnInside(random), counted);
    }
    std::cout << counted << " fragments\n";
    EXPECT_GT(counted, 100000U);
}

TEST(CertifiedCount, IsTheSameByEveryInstructionSet) {
    std::mt19937_64 random(testSeed());
    std::vector<OracleScene> scenes;
    std::vector<std::uint64_t> counts;
    for (int i = 0; i < 60; ++i) {
        scenes.push_back(drawnInside(random));
        counts.push_back(answerTo(scenes.back(), true).count);
    }
    const std::int64_t all = hwy::SupportedTargets();
    for (std::int64_t rest = all; rest != 0; rest &= rest - 1) {
        hwy::SetSupportedTargetsForTest(rest & -rest);
        for (std::size_t i = 0; i < scenes.size(); ++i) {
            EXPECT_EQ(answerTo(scenes[i], false).count, counts[i]) << hwy::TargetName(rest & -rest) << ", scene " << i;
        }
    }
    hwy::SetSupportedTargetsForTest(0);
}

} // namespace
} // namespace voxtact::test
