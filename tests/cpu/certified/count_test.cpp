// SPDX-License-Identifier: MIT
// Fragments that are only counted are as many as those of which something is told.
#include "cpu/scenes/certified_scenes.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "support/host_meters.h"

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
    desc.projection = Projection::Certified;
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

/// Many cells are opaque all over, others in part: a noise above the threshold with holes in it. Now and then the mesh
/// has several clusters.
OracleScene drawnInside(std::mt19937_64& random) {
    Grid grid;
    for (std::uint32_t& size : grid.size) {
        size = 1 + static_cast<std::uint32_t>(below(random, 40));
    }
    OracleScene scene;
    const double holes = chance(random, 0.5) ? 0.003 : 0.1;
    scene.volume = makeVolume<std::uint8_t>(grid, ScalarType::UInt8, [&](auto...) {
        return chance(random, holes) ? 0 : 150 + static_cast<double>(below(random, 100));
    });
    const double size = std::pow(10, uniform(random, -1, 1.5));
    const int triangles = chance(random, 0.2) ? 200 : 20;
    for (int triangle = 0; triangle < triangles; ++triangle) {
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

/// Triangles in the faces of cells, or beside them by as much as rounding may move a triangle, in a volume that is
/// opaque here and there: the first place of a triangle may have a certain point in a cell that its precise place is
/// not in.
OracleScene drawnInFaces(std::mt19937_64& random) {
    Grid grid;
    for (std::uint32_t& size : grid.size) {
        size = 1 + static_cast<std::uint32_t>(below(random, 8));
    }
    OracleScene scene;
    scene.points = {{0, 0}, {140, 0}, {150, 1}, {160, 1}, {170, 0}, {255, 0}};
    scene.volume = makeVolume<std::uint8_t>(grid, ScalarType::UInt8, [&](auto...) {
        constexpr std::array<double, 3> kValues{0, 150, 255};
        return kValues[below(random, 3)];
    });
    for (int triangle = 0; triangle < 30; ++triangle) {
        const std::size_t across = below(random, 3);
        const double beside = uniform(random, -1, 1) * std::pow(10, uniform(random, -8, -3));
        const double face = static_cast<double>(below(random, grid.size[across] + 1)) + beside;
        std::array<Vec3, 3> corners{};
        for (Vec3& corner : corners) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                corner[axis] = axis == across ? face : uniform(random, -1, grid.size[axis] + 1.0);
            }
        }
        addTriangle(scene.mesh, corners[0], corners[1], corners[2]);
    }
    return scene;
}

TEST(CertifiedCount, IsThatInFacesOfCells) {
    std::mt19937_64 random(testSeed());
    std::uint64_t counted = 0;
    for (std::size_t round = 0; round < randomCases(20000, 10) && !HasFailure(); ++round) {
        SCOPED_TRACE(round);
        expectTheSame(drawnInFaces(random), counted);
    }
    std::cout << counted << " fragments\n";
    EXPECT_GT(counted, 10000U);
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
