// SPDX-License-Identifier: MIT
// Which voxels an edit changes: boxes and balls against every voxel of the grid.
#include "core/volume/edit_rows.h"
#include "support/scenes.h"
#include "support/special.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace voxtact::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Grid randomGrid(std::mt19937_64& random) {
    Grid grid;
    const Mat4 turn = randomRotation(random);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = static_cast<std::uint32_t>(uniform(random, 1, 16));
        grid.spacing[axis] = std::pow(10, uniform(random, -1, 1));
        grid.origin[axis] = uniform(random, -100, 100);
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[3 * axis + row] = turn[4 * axis + row];
        }
    }
    if (uniform(random, 0, 1) < 0.3) { // sheared
        grid.direction[3] += 0.3;
    }
    return grid;
}

std::vector<bool> chosen(const std::vector<VoxelRow>& rows, const Grid& grid) {
    std::vector<bool> out(voxelCount(grid), false);
    std::uint64_t before = 0;
    for (const VoxelRow& row : rows) {
        const std::uint64_t order = std::uint64_t{row.z} * grid.size[1] + row.y + 1;
        EXPECT_LT(before, order) << "rows are in order, each once";
        before = order;
        EXPECT_LT(row.firstX, row.endX);
        EXPECT_LE(row.endX, grid.size[0]);
        EXPECT_LT(row.y, grid.size[1]);
        EXPECT_LT(row.z, grid.size[2]);
        for (std::uint32_t x = row.firstX; x < row.endX; ++x) {
            out[(order - 1) * grid.size[0] + x] = true;
        }
    }
    return out;
}

/// Calls visit(x, y, z, number) for every voxel.
template <class Visit> void visitAll(const Grid& grid, Visit&& visit) {
    std::size_t number = 0;
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
                visit(x, y, z, number++);
            }
        }
    }
}

VoxelBox bounds(const std::vector<bool>& voxels, const Grid& grid) {
    std::array<std::uint32_t, 3> lo = grid.size;
    std::array<std::uint32_t, 3> end{};
    visitAll(grid, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z, std::size_t number) {
        if (voxels[number]) {
            lo = {std::min(lo[0], x), std::min(lo[1], y), std::min(lo[2], z)};
            end = {std::max(end[0], x + 1), std::max(end[1], y + 1), std::max(end[2], z + 1)};
        }
    });
    return end[0] == 0 ? VoxelBox{} : VoxelBox{lo, {end[0] - lo[0], end[1] - lo[1], end[2] - lo[2]}};
}

void expectBounds(const VoxelRegion& region, const Grid& grid, const std::vector<bool>& voxels) {
    const VoxelBox expected = bounds(voxels, grid);
    const VoxelBox found = voxelBounds(region, grid).value();
    ASSERT_EQ(found.first, expected.first);
    ASSERT_EQ(found.size, expected.size);
}

/// Distance of a voxel's centre from the ball's, in long double.
long double exactDistance(const Grid& grid, const Ball& ball, const std::array<std::uint32_t, 3>& voxel) {
    long double squared = 0;
    for (std::size_t row = 0; row < 3; ++row) {
        long double at = grid.origin[row];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at += static_cast<long double>(grid.direction[3 * axis + row]) * grid.spacing[axis] * voxel[axis];
        }
        squared += (at - ball.centre[row]) * (at - ball.centre[row]);
    }
    return std::sqrt(squared);
}

TEST(EditRows, ABallHasTheVoxelsWithinItsRadius) {
    std::mt19937_64 random(testSeed());
    std::size_t within = 0;
    std::size_t empty = 0;
    for (int round = 0; round < 1000; ++round) {
        const Grid grid = randomGrid(random);
        Ball ball;
        ball.centre = transformPoint(worldFromTexture(grid), {uniform(random, -0.3, 1.3), uniform(random, -0.3, 1.3),
                                                              uniform(random, -0.3, 1.3)});
        ball.radius = std::pow(10, uniform(random, -1, 2));
        const std::vector<bool> voxels = chosen(voxelRows(ball, grid), grid);
        std::size_t count = 0;
        visitAll(grid, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z, std::size_t number) {
            const long double from = exactDistance(grid, ball, {x, y, z});
            // Either way where rounding decides.
            if (std::abs(from - ball.radius) > 1e-11L) {
                ASSERT_EQ(voxels[number], from < ball.radius) << x << ' ' << y << ' ' << z;
            }
            count += voxels[number] ? 1U : 0U;
        });
        within += count;
        empty += count == 0 ? 1U : 0U;
        expectBounds(ball, grid, voxels);
    }
    EXPECT_GT(within, 10000U);
    EXPECT_GT(empty, 10U);
}

TEST(EditRows, VoxelsOnTheSurfaceBelongToTheBall) {
    std::mt19937_64 random(testSeed());
    std::size_t onSurface = 0;
    for (int round = 0; round < 500; ++round) {
        Grid grid; // every number is a small multiple of 1/4: nothing rounds
        grid.size = {24, 21, 18};
        grid.spacing = {0.25, 0.5, 1};
        grid.direction = {0, 1, 0, 0, 0, -1, 1, 0, 0};
        Ball ball;
        for (double& coordinate : ball.centre) {
            coordinate = std::floor(uniform(random, 0, 40)) / 4;
        }
        ball.radius = std::floor(uniform(random, 0, 28)) / 4;
        const std::vector<bool> voxels = chosen(voxelRows(ball, grid), grid);
        visitAll(grid, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z, std::size_t number) {
            const long double from = exactDistance(grid, ball, {x, y, z});
            ASSERT_EQ(voxels[number], from <= ball.radius) << x << ' ' << y << ' ' << z;
            onSurface += from == ball.radius ? 1U : 0U;
        });
        expectBounds(ball, grid, voxels);
    }
    EXPECT_GT(onSurface, 20U);
}

TEST(EditRows, ABoxHasItsVoxels) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 200; ++round) {
        const Grid grid = randomGrid(random);
        VoxelBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.first[axis] = static_cast<std::uint32_t>(uniform(random, 0, grid.size[axis] + 1.0));
            box.size[axis] = static_cast<std::uint32_t>(uniform(random, 0, grid.size[axis] - box.first[axis] + 1.0));
        }
        const std::vector<bool> voxels = chosen(voxelRows(box, grid), grid);
        visitAll(grid, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z, std::size_t number) {
            const std::array<std::uint32_t, 3> at{x, y, z};
            bool inside = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                inside = inside && box.first[axis] <= at[axis] && at[axis] < box.first[axis] + box.size[axis];
            }
            ASSERT_EQ(voxels[number], inside);
        });
        expectBounds(box, grid, voxels);
    }
}

TEST(EditRows, LargeNumbersDoNoHarm) {
    Grid grid;
    grid.size = {4, 5, 6};
    EXPECT_THAT(voxelBounds(Ball{{0, 0, 0}, 1e300}, grid).value().size, ElementsAre(4, 5, 6));
    EXPECT_THAT(voxelBounds(Ball{{1e300, 1e300, -1e300}, 1e299}, grid).value().size, ElementsAre(0, 0, 0));
    EXPECT_THAT(voxelBounds(Ball{{3, 4, 5}, 0}, grid).value().first, ElementsAre(3, 4, 5));
    EXPECT_THAT(voxelBounds(Ball{{3, 4, 5.5}, 0}, grid).value().size, ElementsAre(0, 0, 0));
}

TEST(EditRows, BadRegionsAreRefused) {
    Grid grid;
    grid.size = {4, 5, 6};
    const auto text = [&](const VoxelRegion& region) { return voxelBounds(region, grid).error().text; };
    EXPECT_THAT(text(VoxelBox{{0, 3, 0}, {1, 3, 1}}), HasSubstr("ends at 6 along y, the image has 5 voxels"));
    EXPECT_THAT(text(VoxelBox{{0xffffffffU, 0, 0}, {1, 1, 1}}), HasSubstr("ends at 4294967296 along x"));
    EXPECT_THAT(text(Ball{{0, 0, 0}, -1}), HasSubstr("radius is -1 mm"));
    EXPECT_THAT(text(Ball{{0, 0, 0}, kNan}), HasSubstr("radius is nan"));
    EXPECT_THAT(text(Ball{{0, 0, 0}, kInfinity}), HasSubstr("radius is inf"));
    EXPECT_THAT(text(Ball{{0, kNan, 0}, 1}), HasSubstr("centre"));
    grid.size[1] = 0;
    EXPECT_THAT(text(Ball{{0, 0, 0}, 1}), HasSubstr("0 voxels along y"));
}

} // namespace
} // namespace voxtact::test
