// SPDX-License-Identifier: MIT
// What the projection `certified` owes to each of its margins and cases, on the host: scenes whose answer is known,
// and that one slip of the pen would get wrong. Each test says which.
#include "cpu/scenes/certified_scenes.h"

#include "cpu/scenes/engine_fixture.h"
#include "host/touch/cells/certified_occupancy.h"
#include "oracle/certified_oracle.h"
#include "support/host_meters.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact::test {
namespace {

using oracle::Certainty;

/// Voxel space is world space and object space. Opacity is value / 255, within half an entry.
OracleScene byteScene(std::uint32_t side, const VoxelFunction& value) {
    Grid grid;
    grid.size = {side, side, side};
    OracleScene scene;
    scene.volume = makeVolume<std::uint8_t>(grid, ScalarType::UInt8, value);
    return scene;
}

/// What the engine says of a scene, which the oracle is sure of.
PairAnswer ask(const OracleScene& scene, Certainty oracle, std::uint32_t threads = 1) {
    EXPECT_EQ(take(oracle::certifiedOracle(scene.pair())).certainty, oracle);
    const oracle::OraclePair pair = scene.pair();
    const cpu::Mesh mesh = take(cpu::Mesh::create(pair.mesh));
    const cpu::Volume volume = take(cpu::Volume::create(pair.volume));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create(pair.transferFunction));
    cpu::Detector detector = take(cpu::Detector::create({.threads = threads, .projection = Projection::Certified}));
    const cpu::BatchItem item{&mesh, &volume, &function, {&pair.world_from_object, 1}};
    return take(detector.detect({{&item, 1}, {}, pair.threshold})).pairs.front();
}

/// All orders of a triangle's corners.
template <class Visit> void eachOrder(std::array<Vec3, 3> corners, const Visit& visit) {
    std::array<std::size_t, 3> order{0, 1, 2};
    do {
        visit(corners[order[0]], corners[order[1]], corners[order[2]]);
    } while (std::next_permutation(order.begin(), order.end()));
}

/// Along the triangle the interpolant is 255 xyz: at its corners and edges nothing, in the middle 255/27. Of its
/// Bernstein coefficients only the middle one says so, and without it in the upper bound contact is missed.
TEST(CertifiedMargins, WhatOnlyTheMiddleOfATriangleReaches) {
    OracleScene scene = byteScene(2, [](auto x, auto y, auto z) { return x + y + z == 3 ? 255 : 0; });
    scene.threshold = 0.02;
    eachOrder({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        scene.mesh = {};
        addTriangle(scene.mesh, a, b, c);
        EXPECT_TRUE(ask(scene, Certainty::Certain).hit);
    });
}

/// The same the other way up: the lower bound.
TEST(CertifiedMargins, WhatOnlyTheMiddleOfATriangleFallsTo) {
    OracleScene scene = byteScene(2, [](auto x, auto y, auto z) { return x + y + z == 3 ? 0 : 255; });
    scene.points = {{0, 1}, {255, 0}};
    scene.threshold = 0.02;
    eachOrder({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        scene.mesh = {};
        addTriangle(scene.mesh, a, b, c);
        EXPECT_TRUE(ask(scene, Certainty::Certain).hit);
    });
}

/// Along one edge the interpolant is 255 v^2 (1 - v), at most 255 * 4/27: of the two Bernstein coefficients between the
/// edge's corners one is 255/3 and the other nothing. Leaving out either, for any order of the corners, misses it.
TEST(CertifiedMargins, WhatOnlyOneThirdOfAnEdgeReaches) {
    for (const bool falling : {false, true}) {
        OracleScene scene = byteScene(2, [&](auto x, auto y, auto z) { return (x + y + z == 3) != falling ? 255 : 0; });
        if (falling) {
            scene.points = {{0, 1}, {255, 0}};
        }
        scene.threshold = 0.1;
        eachOrder({{{0, 0, 1}, {1, 1, 0}, {0, 0, 0}}}, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
            scene.mesh = {};
            addTriangle(scene.mesh, a, b, c);
            EXPECT_TRUE(ask(scene, Certainty::Certain).hit);
        });
    }
}

/// A pair's tasks are many, and one of them has a fragment that cannot be decided: the others, which end after it,
/// must not say otherwise. All voxels have the value whose opacity is the threshold but for a rounding. Whatever
/// the order of the clusters, what is on one side of it or on the other comes after it.
TEST(CertifiedMargins, OneUndecidedFragmentAmongThousandsIsKept) {
    for (const int side : {-1, 0, 1}) {
        OracleScene scene = byteScene(8, [](auto...) { return 200; });
        scene.points = {{0, 0}, {255, 1}};
        scene.threshold = 200.0 / 255;
        addTriangle(scene.mesh, {2.2, 2.2, 2.2}, {2.4, 2.2, 2.3}, {2.3, 2.4, 2.3}); // soon given up
        for (int i = 0; i < 12000; ++i) { // beside the volume, farther and farther
            const bool right = side == 0 ? i % 2 == 0 : side > 0;
            const double x = right ? 20 + 0.5 * i : -20 - 0.5 * i;
            addTriangle(scene.mesh, {x, 1, 1}, {x, 2, 1}, {x, 1, 2});
        }
        for (int round = 0; round < 10; ++round) {
            const PairAnswer answer = ask(scene, Certainty::Undecided, 4);
            EXPECT_FALSE(answer.hit);
            EXPECT_TRUE(answer.possible);
            EXPECT_EQ(answer.exactness, Exactness::LowerBound);
        }
    }
}

/// What the tasks of a pair count is added up.
TEST(CertifiedMargins, TheCountIsThatOfAllTasks) {
    OracleScene scene = byteScene(16, [](auto...) { return 200; });
    scene.threshold = 0.5;
    std::mt19937_64 random(testSeed());
    for (int i = 0; i < 4000; ++i) {
        const Vec3 at{uniform(random, 1, 14), uniform(random, 1, 14), uniform(random, 1, 14)};
        addTriangle(scene.mesh, at, {at[0] + 0.1, at[1], at[2]}, {at[0], at[1] + 0.1, at[2]});
    }
    const PairAnswer alone = ask(scene, Certainty::Certain, 1);
    EXPECT_GE(alone.count, 4000U);
    for (int round = 0; round < 5; ++round) {
        EXPECT_EQ(ask(scene, Certainty::Certain, 4).count, alone.count);
    }
}

/// A sliver's normal is what rounding leaves of it. Its plane is not said to miss a cube whose middle the sliver passes
/// through, which needs the error of the normal in addition to the displacement of the corners.
TEST(CertifiedMargins, ASliverThroughACubeIsNotSaidToMissIt) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    std::size_t missed = 0;
    const auto vector = [&](double size) {
        return Vec3{size * uniform(random, -1, 1), size * uniform(random, -1, 1), size * uniform(random, -1, 1)};
    };
    for (int round = 0; round < 20000; ++round) {
        const Vec3 centre = vector(50);
        const Vec3 along = vector(20);
        const Vec3 across = vector(std::pow(10, uniform(random, -7, 0)));
        std::array<shader::VoxelPoint, 3> corners{};
        const std::array<std::array<double, 2>, 3> places{{{-uniform(random, 0.1, 1), -1}, {1, -1}, {0, 2}}};
        for (std::size_t i = 0; i < 3; ++i) { // around the centre
            const auto at = [&](std::size_t axis) {
                return static_cast<float>(centre[axis] + places[i][0] * along[axis] + places[i][1] * across[axis]);
            };
            corners[i] = {at(0), at(1), at(2)};
        }
        const shader::CertifiedTriangle triangle = shader::certifiedTriangle(corners[0], corners[1], corners[2], 1e-5F);
        const auto at = [&](std::size_t axis, double off) { return static_cast<float>(centre[axis] + off); };
        const double off = uniform(random, -0.45, 0.45);
        EXPECT_FALSE(shader::certifiedPlaneMisses(triangle, {at(0, off), at(1, -off), at(2, off)}, 0.5F))
            << "seed " << seed << ", round " << round;
        missed += shader::certifiedPlaneMisses(triangle, {at(0, 9), at(1, -3), at(2, 5)}, 0.5F) ? 1U : 0U;
    }
    EXPECT_GT(missed, 1000U) << "a plane that never misses proves nothing";
}

template <class Scalar> float storedAt(const VolumeData& data, const std::array<std::int64_t, 3>& voxel) {
    std::size_t at = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
        const auto last = static_cast<std::int64_t>(data.grid.size[axis]) - 1;
        at = at * data.grid.size[axis] + static_cast<std::size_t>(std::clamp<std::int64_t>(voxel[axis], 0, last));
    }
    Scalar value{};
    std::memcpy(&value, data.voxels.data() + at * sizeof value, sizeof value);
    return static_cast<float>(value);
}

/// The voxels that a displaced point's slope is bounded by: all corners of a brick's cells, and of those one farther
/// out on every side. One row less, and a certain answer may be wrong.
TEST(CertifiedMargins, ABrickKnowsTheVoxelsAroundIt) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    for (int round = 0; round < 20; ++round) {
        Grid grid;
        for (std::uint32_t& size : grid.size) {
            size = static_cast<std::uint32_t>(uniform(random, 1, 28));
        }
        // Few voxels stand out, so that each matters to a brick.
        const VolumeData data = makeVolume<std::int16_t>(grid, ScalarType::Int16, [&](auto...) {
            return uniform(random, 0, 1) < 0.01 ? uniform(random, -3e4, 3e4) : 0;
        });
        const cpu::Volume volume = take(cpu::Volume::create(data.view()));
        const std::array points{ControlPoint{0, 1}, ControlPoint{1, 1}};
        const cpu::TransferFunction function = take(cpu::TransferFunction::create({points, {-3e4, 3e4}, 16}));
        const cpu::CertifiedOccupancy occupancy(volume.impl(), function.impl(), 0.5, 1.0 / 64);
        const double intercept = volume.impl().storedIntercept;
        const auto bricks = [&](std::size_t axis) {
            return static_cast<std::int32_t>(grid.size[axis] >> kBrickShift) + 1;
        };
        for (std::int32_t z = 0; z < bricks(2); ++z) {
            for (std::int32_t y = 0; y < bricks(1); ++y) {
                for (std::int32_t x = 0; x < bricks(0); ++x) {
                    float lo = std::numeric_limits<float>::infinity();
                    float hi = -lo;
                    for (std::int64_t k = 8 * z - 2; k <= 8 * z + 8; ++k) {
                        for (std::int64_t j = 8 * y - 2; j <= 8 * y + 8; ++j) {
                            for (std::int64_t i = 8 * x - 2; i <= 8 * x + 8; ++i) {
                                const float value = storedAt<std::int16_t>(data, {i, j, k});
                                lo = std::min(lo, value);
                                hi = std::max(hi, value);
                            }
                        }
                    }
                    const cpu::BrickCells& known = occupancy.cells(volume.impl(), {x, y, z});
                    ASSERT_EQ(static_cast<double>(known.wideLo) + intercept, lo) << "seed " << seed << ", " << round;
                    ASSERT_EQ(static_cast<double>(known.wideHi) + intercept, hi) << "seed " << seed << ", " << round;
                }
            }
        }
    }
}

} // namespace
} // namespace voxtact::test
