// SPDX-License-Identifier: MIT
// Triangles that are long, and perhaps thin: no box that one passes through is said to be missed, most others are, and
// what is counted is what an oracle finds.
#include "cpu/judges/certified_judge.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "host/touch/cells/brick_rows.h"
#include "support/host_meters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace voxtact::test {
namespace {

using shader::CertifiedTriangle;
using shader::VoxelPoint;

/// Some voxels to some hundreds long, and down to a thousandth of a voxel wide.
struct LongTriangle {
    std::array<Vec3, 3> corners{};
    CertifiedTriangle triangle{};

    explicit LongTriangle(std::mt19937_64& random) {
        const auto vector = [&](double size) {
            return Vec3{size * uniform(random, -1, 1), size * uniform(random, -1, 1), size * uniform(random, -1, 1)};
        };
        const Vec3 first = vector(100);
        const Vec3 along = vector(std::pow(10, uniform(random, 0, 2.5)));
        const Vec3 across = vector(std::pow(10, uniform(random, -3, chance(random, 0.5) ? 0 : 2)));
        std::array<VoxelPoint, 3> points{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double at = first[axis] + (i > 0 ? along[axis] : 0) + (i == 2 ? across[axis] : 0);
                corners[i][axis] = static_cast<double>(static_cast<float>(at));
            }
            points[i] = pointOf(corners[i]);
        }
        triangle = shader::certifiedTriangle(points[0], points[1], points[2], 1e-2F);
    }
    static VoxelPoint pointOf(const Vec3& at) {
        return {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])};
    }
    /// A place in it, displaced by less than its delta.
    [[nodiscard]] Vec3 somewhere(std::mt19937_64& random) const {
        const double u = uniform(random, 0, 1);
        const double v = uniform(random, 0, 1) * (1 - u);
        Vec3 at{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at[axis] = corners[0][axis] + u * (corners[1][axis] - corners[0][axis]) +
                       v * (corners[2][axis] - corners[0][axis]) + uniform(random, -9e-3, 9e-3);
        }
        return at;
    }
    [[nodiscard]] bool misses(const VoxelPoint& centre, const VoxelPoint& radius) const {
        return shader::certifiedEdgesMissBox(triangle, centre, radius) ||
               shader::certifiedPlaneMissesBox(triangle, centre, radius);
    }
};

TEST(LongTriangles, AreNotSaidToMissABoxThatTheyPassThrough) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    std::size_t missed = 0;
    std::size_t far = 0;
    for (int round = 0; round < 20000; ++round) {
        const LongTriangle at(random);
        const Vec3 inside = at.somewhere(random);
        Vec3 centre{};
        Vec3 radius{};
        Vec3 beside{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            radius[axis] = std::pow(10, uniform(random, -1, 1.5));
            centre[axis] = inside[axis] + radius[axis] * uniform(random, -1, 1) * (1 - 1e-5);
            beside[axis] = centre[axis] + radius[axis] * (chance(random, 0.5) ? 3 : -3);
        }
        const VoxelPoint sides = LongTriangle::pointOf(radius);
        EXPECT_FALSE(at.misses(LongTriangle::pointOf(centre), sides)) << "seed " << seed << ", round " << round;
        // A box beside it is missed, unless another part of the triangle is there.
        bool there = false;
        for (int i = 0; i < 50 && !there; ++i) {
            const Vec3 place = at.somewhere(random);
            there = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                there = there && std::abs(place[axis] - beside[axis]) <= radius[axis] + 1;
            }
        }
        far += there ? 0 : 1;
        missed += !there && at.misses(LongTriangle::pointOf(beside), sides) ? 1U : 0U;
    }
    std::cout << missed << " of " << far << " boxes are missed\n";
    EXPECT_GT(missed, far * 3 / 4);
}

TEST(LongTriangles, AreInTheirRowsOfBricks) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    std::size_t inRows = 0;
    std::size_t inBox = 0;
    for (int round = 0; round < 3000; ++round) {
        const LongTriangle at(random);
        cpu::BrickBox box;
        const auto brickAt = [](double place) {
            return static_cast<std::int32_t>(std::floor((place + 1) / cpu::kBrickSide));
        };
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto [lo, hi] = std::minmax({at.corners[0][axis], at.corners[1][axis], at.corners[2][axis]});
            box.lo[axis] = brickAt(lo - 2e-2);
            box.hi[axis] = brickAt(hi + 2e-2);
        }
        const cpu::BrickRows rows(at.triangle, box);
        inBox += static_cast<std::size_t>(box.volume());
        for (std::int32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
            const cpu::BrickRows::Piece layer = rows.layer(z);
            const cpu::BrickRows::Span span = rows.rows(layer);
            for (std::int32_t y = span.first; y <= span.last; ++y) {
                const cpu::BrickRows::Span row = rows.row(layer, y);
                inRows += static_cast<std::size_t>(std::max(row.last - row.first + 1, 0));
            }
        }
        for (int i = 0; i < 50; ++i) {
            const Vec3 place = at.somewhere(random);
            const cpu::BrickRows::Piece layer = rows.layer(brickAt(place[2]));
            const cpu::BrickRows::Span span = rows.rows(layer);
            const std::int32_t y = brickAt(place[1]);
            ASSERT_TRUE(span.first <= y && y <= span.last) << "seed " << seed << ", round " << round;
            const cpu::BrickRows::Span row = rows.row(layer, y);
            const std::int32_t x = brickAt(place[0]);
            ASSERT_TRUE(row.first <= x && x <= row.last) << "seed " << seed << ", round " << round;
        }
    }
    std::cout << inRows << " bricks are in rows, " << inBox << " in boxes\n";
    EXPECT_LT(inRows, inBox / 8);
}

/// Slivers, and some that are as wide as long, through all of a volume with a ball in it.
TEST(LongTriangles, AreCountedAsTheOracleDoes) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    cpu::Detector detector = take(
        cpu::Detector::create({.threads = 1, .projection = Projection::Certified, .outputs = {.triangles = true}}));
    cpu::Detector bare = take(cpu::Detector::create({.threads = 1, .projection = Projection::Certified}));
    std::uint64_t counted = 0;
    for (int round = 0; round < 4; ++round) {
        Grid grid;
        grid.size = {60, 50, 70};
        OracleScene scene;
        scene.volume =
            makeVolume<std::uint8_t>(grid, ScalarType::UInt8, [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
                return std::clamp(350 - 8 * std::hypot(x - 30.0, y - 25.0, z - 35.0), 0.0, 255.0);
            });
        for (int i = 0; i < 6; ++i) {
            Vec3 from{};
            Vec3 to{};
            Vec3 third{};
            const double width = i == 0 ? 30 : std::pow(10, uniform(random, -3, 0));
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double reach = 0.6 * grid.size[axis];
                from[axis] = 0.5 * grid.size[axis] + uniform(random, -reach, reach);
                to[axis] = grid.size[axis] - from[axis] + uniform(random, -5, 5);
                third[axis] = to[axis] + width * uniform(random, -1, 1);
            }
            addTriangle(scene.mesh, from, to, third);
        }
        const CertifiedCase c = withTable(scene);
        const EngineSays says = take(askEngine(detector, c));
        EXPECT_EQ(complaints(says, take(oracle::certifiedOracle(c.scene.pair())), countCells(c)), "")
            << "seed " << seed << ", round " << round;
        EXPECT_EQ(take(askEngine(bare, c)).pair.count, says.pair.count) << "seed " << seed << ", round " << round;
        counted += says.pair.count;
    }
    std::cout << counted << " fragments\n";
    EXPECT_GT(counted, 1000U);
}

} // namespace
} // namespace voxtact::test
