// SPDX-License-Identifier: MIT
// Balls whose surface passes through voxel centres, or by them as closely as doubles can say: every voxel against sums
// without rounding of another kind (Shewchuk, "Adaptive precision floating-point arithmetic", 1997) than those that
// decide.
#include "core/base/exact_number.h"
#include "core/volume/ball_rows.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace voxtact::test {
namespace {

/// A sum of doubles that do not overlap, the least first: exact while nothing overflows or underflows.
using Expansion = std::vector<double>;

void add(Expansion& sum, double term) {
    Expansion out;
    for (const double part : sum) {
        const double whole = term + part;
        const double partOfWhole = whole - term;
        const double lost = (term - (whole - partOfWhole)) + (part - partOfWhole);
        if (lost != 0) {
            out.push_back(lost);
        }
        term = whole;
    }
    if (term != 0 || out.empty()) {
        out.push_back(term);
    }
    sum = out;
}

Expansion times(const Expansion& a, const Expansion& b) {
    Expansion out;
    for (const double x : a) {
        for (const double y : b) {
            add(out, std::fma(x, y, -(x * y)));
            add(out, x * y);
        }
    }
    return out;
}

/// The sign of the square of a voxel's distance from a ball's centre less that of the radius.
int exactlyBeyond(const Grid& grid, const Ball& ball, const std::array<std::uint32_t, 3>& voxel) {
    const Expansion squared = times({ball.radius}, {ball.radius});
    Expansion sum;
    for (const double part : squared) {
        add(sum, -part);
    }
    for (std::size_t row = 0; row < 3; ++row) {
        Expansion at{grid.origin[row]};
        add(at, -ball.centre[row]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Expansion step = times({grid.direction[3 * axis + row]}, {grid.spacing[axis]});
            for (const double part : times(step, {static_cast<double>(voxel[axis])})) {
                add(at, part);
            }
        }
        for (const double part : times(at, at)) {
            add(sum, part);
        }
    }
    return sum.back() < 0 ? -1 : (sum.back() > 0 ? 1 : 0);
}

struct Tally {
    std::size_t on = 0;   ///< voxels exactly on a ball's surface
    std::size_t near = 0; ///< voxels whose side the square of the distance in double does not tell
};

/// The distance as a user would compute it.
double distance(const Grid& grid, const Ball& ball, const std::array<std::uint32_t, 3>& voxel) {
    const Vec3 at = transformPoint(worldFromIndex(grid), {static_cast<double>(voxel[0]), static_cast<double>(voxel[1]),
                                                          static_cast<double>(voxel[2])});
    return std::hypot(at[0] - ball.centre[0], at[1] - ball.centre[1], at[2] - ball.centre[2]);
}

/// The same, where doubles are sure of it at less cost.
int beyond(const Grid& grid, const Ball& ball, const std::array<std::uint32_t, 3>& voxel) {
    double terms = ball.radius;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        terms += std::abs(grid.origin[axis]) + std::abs(ball.centre[axis]) + 3 * grid.spacing[axis] * voxel[axis];
    }
    const double from = distance(grid, ball, voxel) - ball.radius;
    if (std::abs(from) > 1e-10 * terms) {
        return from < 0 ? -1 : 1;
    }
    return exactlyBeyond(grid, ball, voxel);
}

void expectExact(const Grid& grid, const Ball& ball, Tally& tally) {
    std::vector<bool> within(voxelCount(grid), false);
    const auto number = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return (std::size_t{z} * grid.size[1] + y) * grid.size[0] + x;
    };
    for (const VoxelRow& row : ballRows(ball, grid)) {
        for (std::uint32_t x = row.firstX; x < row.endX; ++x) {
            within[number(x, row.y, row.z)] = true;
        }
    }
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
                const int side = beyond(grid, ball, {x, y, z});
                ASSERT_EQ(within[number(x, y, z)], side <= 0)
                    << x << ' ' << y << ' ' << z << ", radius " << ball.radius << ", side " << side;
                tally.on += side == 0 ? 1U : 0U;
                tally.near += std::abs(distance(grid, ball, {x, y, z}) - ball.radius) < 1e-14 * ball.radius ? 1U : 0U;
            }
        }
    }
}

Grid turned(std::mt19937_64& random) {
    Grid grid;
    const Mat4 turn = randomRotation(random);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[3 * axis + row] = turn[4 * axis + row];
        }
    }
    return grid;
}

/// The centre of a voxel, rounded to doubles.
Vec3 centreOf(const Grid& grid, const Vec3& voxel) {
    return transformPoint(worldFromIndex(grid), voxel);
}

TEST(BallRows, WholeRadiiOnAUnitGrid) {
    Grid grid;
    grid.size = {31, 31, 31};
    Tally tally;
    for (const double radius : {0.0, 1.0, 3.0, 5.0, 7.0, 9.0, 13.0, 15.0}) { // 1+4+4, 9+16, 4+9+36, 16+16+49, …
        expectExact(grid, {{15, 15, 15}, radius}, tally);
    }
    EXPECT_GT(tally.on, 250U);
    // As many points of a lattice as squares sum up to: 3^2 in 30 ways, 5^2 in 30, 7^2 in 54, 9^2 in 102.
    Tally nine;
    expectExact(grid, {{15, 15, 15}, 9}, nine);
    EXPECT_EQ(nine.on, 102U);
}

TEST(BallRows, PythagoreanPointsOnScaledGrids) {
    Tally tally;
    for (const double unit : {0.1, 0.3, 0.7, 1.0 / 3, 0.9375, 1.1, 123.456}) {
        Grid grid;
        grid.size = {15, 15, 15};
        grid.spacing = {unit, unit, unit};
        for (const double radius : {3.0, 5.0, 7.0}) {
            // In both roundings of what is meant: spacing times a whole number.
            expectExact(grid, {{7 * unit, 7 * unit, 7 * unit}, radius * unit}, tally);
            expectExact(grid, {{0, 0, 0}, radius * unit}, tally);
        }
        grid.spacing = {unit, 2 * unit, unit / 2};
        expectExact(grid, {{0, 0, 0}, 5 * unit}, tally);
        grid.origin = {-100 * unit, 0.1, 1000.0 / 3};
        expectExact(grid, {centreOf(grid, {7, 7, 7}), 5 * unit}, tally);
    }
    EXPECT_GT(tally.on, 50U);
    EXPECT_GT(tally.near, 1000U);
}

/// The radius is the distance of a voxel, rounded: the next double above and below it, too.
TEST(BallRows, ObliqueGridsAndRadiiThatEndAtAVoxel) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    Tally tally;
    for (int round = 0; round < 300; ++round) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
        Grid grid = turned(random);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            grid.size[axis] = static_cast<std::uint32_t>(uniform(random, 1, 12));
            grid.spacing[axis] = std::pow(10, uniform(random, -1, 1));
            grid.origin[axis] = uniform(random, -1, 1) * std::pow(10, uniform(random, 0, 6));
        }
        const auto voxel = [&](std::size_t axis) { return std::floor(uniform(random, 0, grid.size[axis])); };
        Ball ball{centreOf(grid, {voxel(0), voxel(1), voxel(2)}), 0};
        const Vec3 end{voxel(0), voxel(1), voxel(2)};
        ball.radius = distance(grid, ball,
                               {static_cast<std::uint32_t>(end[0]), static_cast<std::uint32_t>(end[1]),
                                static_cast<std::uint32_t>(end[2])});
        const double most = std::numeric_limits<double>::infinity();
        for (const double radius : {ball.radius, std::nextafter(ball.radius, most), std::nextafter(ball.radius, 0.0)}) {
            ball.radius = radius;
            ASSERT_NO_FATAL_FAILURE(expectExact(grid, ball, tally));
        }
    }
    EXPECT_GT(tally.near, 500U);
}

/// No guess in double finds the row here: the voxels' numbers are lost next to the coordinates.
TEST(BallRows, WhereDoublesCannotTellOneVoxelFromTheNext) {
    Grid grid;
    grid.size = {9, 8, 7};
    Tally tally;
    for (const double origin : {1e9, 1e11, -1e12}) {
        const double unit = std::abs(origin) * 0x1p-58; // as 1 is to 1e17 and more
        grid.spacing = {std::max(unit, kMinSpacing), std::max(unit, kMinSpacing), std::max(unit, kMinSpacing)};
        grid.origin = {origin, -origin, origin};
        expectExact(grid, {{origin, -origin, origin}, 3 * grid.spacing[0]}, tally);
        expectExact(grid, {{std::nextafter(origin, 2 * origin), -origin, origin}, std::abs(origin) * 0x1p-52}, tally);
    }
    EXPECT_GT(tally.on, 0U);
}

TEST(BallRows, ALargeBallHasItsVolume) {
    Grid grid;
    grid.size = {512, 512, 512};
    grid.spacing = {0.3, 0.3, 0.3};
    std::size_t voxels = 0;
    for (const VoxelRow& row : ballRows({centreOf(grid, {256, 256, 256}), 60}, grid)) {
        voxels += row.endX - row.firstX;
    }
    EXPECT_NEAR(static_cast<double>(voxels), 4.0 / 3 * 3.14159265 * 200 * 200 * 200, 1e5);
}

TEST(ExactNumber, KnowsTheSignsOfSums) {
    const ExactNumber one(1);
    const ExactNumber tiny(0x1p-1074);
    const ExactNumber huge(std::numeric_limits<double>::max());
    EXPECT_EQ(ExactNumber(0).sign(), 0);
    EXPECT_EQ(ExactNumber(-0.0).sign(), 0);
    EXPECT_EQ((one - one).sign(), 0);
    EXPECT_EQ((ExactNumber(-3) + one).sign(), -1);
    EXPECT_EQ((huge * huge + tiny - huge * huge).sign(), 1);
    EXPECT_EQ((huge * huge - tiny * tiny - huge * huge).sign(), -1);
    EXPECT_EQ((tiny * tiny * huge).sign(), 1);
    EXPECT_EQ((ExactNumber(0) * huge - tiny).sign(), -1);
    // Carries and borrows over many words.
    EXPECT_EQ((ExactNumber(0x1p96) - one + one - ExactNumber(0x1p96)).sign(), 0);
    EXPECT_EQ((ExactNumber(0x1p96) - one - ExactNumber(0x1p96)).sign(), -1);
}

TEST(ExactNumber, KeepsTheLawsOfArithmetic) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const auto draw = [&] { return uniform(random, -1, 1) * std::pow(2, std::floor(uniform(random, -200, 200))); };
    for (int round = 0; round < 5000; ++round) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
        const double x = draw();
        const double y = draw();
        const ExactNumber a(x);
        const ExactNumber b(y);
        const ExactNumber c(draw());
        EXPECT_EQ((a - b).sign(), x < y ? -1 : (x > y ? 1 : 0));
        EXPECT_EQ((a * b).sign(), (x < 0) == (y < 0) ? 1 : -1);
        EXPECT_EQ(((a + b) * c - a * c - b * c).sign(), 0);
        EXPECT_EQ(((a + b) * (a - b) - a * a + b * b).sign(), 0);
        EXPECT_EQ((a * a - ExactNumber(std::nextafter(x, 0.0)) * a).sign(), 1);
        // What a product rounds off is a double.
        EXPECT_EQ((a * b - ExactNumber(x * y) - ExactNumber(std::fma(x, y, -(x * y)))).sign(), 0);
    }
}

} // namespace
} // namespace voxtact::test
