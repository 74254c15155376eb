// SPDX-License-Identifier: MIT
// The cubes that an octree has of a volume: where they are, and what they say.
#include "bench/engines/opaque_cells.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

using lab::OpaqueCells;
using lab::opaqueCells;

constexpr double kThreshold = 0.5;

Grid turned(const std::array<std::uint32_t, 3>& size, const Vec3& spacing, bool mirrored, std::mt19937_64& random) {
    Grid grid;
    grid.size = size;
    grid.spacing = spacing;
    grid.origin = {uniform(random, -50, 50), uniform(random, -50, 50), uniform(random, -50, 50)};
    const Mat4 rotation = randomRotation(random);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[3 * axis + row] = rotation[4 * axis + row] * (mirrored ? -1 : 1);
        }
    }
    return grid;
}

Vec3 centreOf(const OpaqueCells& cells, std::size_t x, std::size_t y, std::size_t z) {
    const auto at = [&](std::size_t i) { return (static_cast<double>(i) + 0.5) * cells.side; };
    return transformPoint(cells.world_from_cells, {at(x), at(y), at(z)});
}

/// Every cell says of the voxel at its centre whether it is opaque, and every voxel has a cell.
void expectFaithful(const Grid& grid, std::uint32_t modulus) {
    const VolumeData volume =
        makeBytes(grid, [modulus](auto x, auto y, auto z) { return (x * 7 + y * 3 + z) % modulus == 0 ? 255.0 : 0.0; });
    const Result<OpaqueCells> made = opaqueCells(volume.view(), {byteRamp(), {0, 255}, 256}, kThreshold);
    ASSERT_TRUE(made.ok()) << made.error().text;
    const OpaqueCells& cells = *made;
    const Mat4 index_from_world = *inverse(worldFromIndex(grid));
    std::vector<bool> seen(volume.voxels.size());
    std::size_t cell = 0;
    for (std::uint32_t z = 0; z < cells.size[2]; ++z) {
        for (std::uint32_t y = 0; y < cells.size[1]; ++y) {
            for (std::uint32_t x = 0; x < cells.size[0]; ++x, ++cell) {
                const Vec3 index = transformPoint(index_from_world, centreOf(cells, x, y, z));
                std::array<std::size_t, 3> voxel{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    voxel[axis] = static_cast<std::size_t>(
                        std::clamp(std::round(index[axis]), 0.0, static_cast<double>(grid.size[axis] - 1)));
                }
                const std::size_t at = (voxel[2] * grid.size[1] + voxel[1]) * grid.size[0] + voxel[0];
                seen[at] = true;
                ASSERT_EQ(cells.opaque[cell], volume.voxels[at] == std::byte{255}) << x << " " << y << " " << z;
            }
        }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), false), 0);
    const auto determinant = [&] {
        const Mat4& m = cells.world_from_cells;
        return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
               m[8] * (m[1] * m[6] - m[2] * m[5]);
    };
    EXPECT_NEAR(determinant(), 1, 1e-9) << "rigid, whatever the grid";
}

TEST(OpaqueCellsTest, CellsOfGridsAtAnyAngle) {
    std::mt19937_64 random(testSeed());
    for (const bool mirrored : {false, true}) {
        expectFaithful(turned({5, 7, 4}, {0.7, 0.7, 0.7}, mirrored, random), 3);
        // Sides that no cell's centre is on the edge of.
        expectFaithful(turned({6, 5, 4}, {0.5, 1.05, 2.15}, mirrored, random), 4);
    }
}

TEST(OpaqueCellsTest, OnlyCubesAreNotResampled) {
    std::mt19937_64 random(testSeed());
    const auto resampled = [&](const Vec3& spacing) {
        const VolumeData volume =
            makeBytes(turned({3, 3, 3}, spacing, false, random), [](auto, auto, auto) { return 255; });
        return opaqueCells(volume.view(), {byteRamp(), {0, 255}, 256}, kThreshold)->resampled;
    };
    EXPECT_FALSE(resampled({2, 2, 2}));
    EXPECT_TRUE(resampled({2, 2, 3}));
}

TEST(OpaqueCellsTest, AShearedGridIsRefused) {
    Grid grid = unitGrid(4);
    grid.direction = {1, 0, 0, 0.6, 0.8, 0, 0, 0, 1};
    const VolumeData volume = makeBytes(grid, [](auto, auto, auto) { return 255; });
    const Result<OpaqueCells> made = opaqueCells(volume.view(), {byteRamp(), {0, 255}, 256}, kThreshold);
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.error().text, "the axes of the grid are not at right angles");
}

} // namespace
} // namespace voxtact::test
