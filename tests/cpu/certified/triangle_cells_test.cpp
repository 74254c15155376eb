// SPDX-License-Identifier: MIT
// What is said of the cells of a cube without cutting the triangle, against cutting it.
#include "host/touch/cells/triangle_cells.h"

#include "cpu/scenes/random_scene.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iostream>

namespace voxtact::test {
namespace {

using cpu::TriangleCells;
using shader::CertifiedTriangle;
using shader::VoxelPoint;

using Corners = std::array<VoxelPoint, 3>;

/// Slivers, points and lines, planes of voxels' centres and faces, and what is none of these.
Corners drawnCorners(std::mt19937_64& random) {
    const double size = std::pow(10, uniform(random, -2, 1.6));
    const double place = chance(random, 0.2) ? 1000 : 30;
    Corners corners{};
    const VoxelPoint middle{drawn(random, 0, place), drawn(random, 0, place), drawn(random, 0, place)};
    for (VoxelPoint& corner : corners) {
        corner = {middle.x + drawn(random, -size, size), middle.y + drawn(random, -size, size),
                  middle.z + drawn(random, -size, size)};
    }
    if (chance(random, 0.2)) { // a sliver
        const float part = drawn(random, -0.5, 1.5);
        const float off = chance(random, 0.3) ? 0 : drawn(random, 0, 1e-3);
        corners[2] = {corners[0].x + part * (corners[1].x - corners[0].x) + off,
                      corners[0].y + part * (corners[1].y - corners[0].y),
                      corners[0].z + part * (corners[1].z - corners[0].z)};
    }
    if (chance(random, 0.2)) {
        const auto axis = static_cast<std::size_t>(below(random, 3));
        const float at = 0.5F * std::round(2 * middle.x);
        for (VoxelPoint& corner : corners) {
            (axis == 0 ? corner.x : axis == 1 ? corner.y : corner.z) = at;
        }
    }
    if (chance(random, 0.2)) { // a side that is far shorter than the others
        const double side = std::pow(10, uniform(random, -5, -1));
        const std::size_t corner = below(random, 3);
        const VoxelPoint& at = corners[(corner + 1) % 3];
        corners[corner] = {at.x + drawn(random, -side, side), at.y + drawn(random, -side, side),
                           at.z + drawn(random, -side, side)};
    }
    if (chance(random, 0.05)) {
        corners[1] = corners[0];
    }
    return corners;
}

/// `error` of each vertex.
CertifiedTriangle triangleOf(const Corners& corners, float error) {
    shader::CertifiedItem item{};
    item.sizeX = item.sizeY = item.sizeZ = 2000;
    const float delta =
        shader::certifiedBounds(item, {corners[0], error}, {corners[1], error}, {corners[2], error}).delta;
    return shader::certifiedTriangle(corners[0], corners[1], corners[2], delta);
}

bool cutLeavesSome(const CertifiedTriangle& triangle, std::int32_t x, std::int32_t y, std::int32_t z) {
    shader::CertifiedCell cell{};
    cell.hi = {1, 1, 1};
    VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
    const VoxelPoint origin{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    return shader::certifiedClip(triangle, cell, origin, polygon) > 0;
}

constexpr auto kCubeSide = static_cast<std::int32_t>(TriangleCells::kSide);
constexpr std::int32_t kCubeCells = kCubeSide * kCubeSide * kCubeSide;

/// The cell of a number in the cube from `first` on.
std::array<std::int32_t, 3> cellOfCube(const std::array<std::int32_t, 3>& first, std::int32_t number) {
    return {first[0] + number % kCubeSide, first[1] + number / kCubeSide % kCubeSide,
            first[2] + number / (kCubeSide * kCubeSide)};
}

/// Cubes from the last cell before to the first one after.
template <class Visit> void forCubes(const Corners& corners, const Visit& visit) {
    std::array<std::int32_t, 3> lo{};
    std::array<std::int32_t, 3> hi{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto of = [&](std::size_t i) { return shader::voxelAlong(corners[i], static_cast<int>(axis)); };
        lo[axis] = static_cast<std::int32_t>(std::floor(std::min({of(0), of(1), of(2)}))) - 1;
        hi[axis] = static_cast<std::int32_t>(std::floor(std::max({of(0), of(1), of(2)}))) + 1;
    }
    for (std::int32_t z = lo[2]; z <= hi[2]; z += kCubeSide) {
        for (std::int32_t y = lo[1]; y <= hi[1]; y += kCubeSide) {
            for (std::int32_t x = lo[0]; x <= hi[0]; x += kCubeSide) {
                visit(std::array{x, y, z});
            }
        }
    }
}

TEST(TriangleCellsTest, SayWhatCuttingLeaves) {
    std::mt19937_64 random(testSeed());
    std::size_t some = 0;
    std::size_t none = 0;
    std::size_t unclear = 0;
    for (std::size_t round = 0; round < randomCases(100000, 10) && !HasFailure(); ++round) {
        const Corners corners = drawnCorners(random);
        const CertifiedTriangle triangle =
            triangleOf(corners, chance(random, 0.3) ? drawn(random, 0, 4.5e-4) : drawn(random, 0, 1e-4));
        if (!TriangleCells::mayBeAsked(triangle)) {
            continue;
        }
        const TriangleCells cells(triangle);
        forCubes(corners, [&](const std::array<std::int32_t, 3>& first) {
            const TriangleCells::Bits asked = chance(random, 0.5) ? ~TriangleCells::Bits{0} : random();
            const TriangleCells::Overlap overlap = cells.of(asked, first);
            EXPECT_EQ(overlap.some & overlap.none, 0U);
            EXPECT_EQ((overlap.some | overlap.none) & ~asked, 0U);
            for (std::int32_t i = 0; i < kCubeCells; ++i) {
                const TriangleCells::Bits bit = TriangleCells::Bits{1} << static_cast<unsigned>(i);
                if (((overlap.some | overlap.none) & bit) != 0) {
                    const auto [x, y, z] = cellOfCube(first, i);
                    EXPECT_EQ(cutLeavesSome(triangle, x, y, z), (overlap.some & bit) != 0)
                        << "round " << round << ", cell " << x << ", " << y << ", " << z;
                }
            }
            some += static_cast<std::size_t>(std::popcount(overlap.some));
            none += static_cast<std::size_t>(std::popcount(overlap.none));
            unclear += static_cast<std::size_t>(std::popcount(asked & ~(overlap.some | overlap.none)));
        });
    }
    std::cout << some << " pass, " << none << " do not, " << unclear << " are unclear\n";
    EXPECT_GT(some, 10000U);
    EXPECT_LT(unclear, some / 4);
}

/// The same of one cell at a time, as a device asks it.
TEST(TriangleCellsTest, OneCellIsSaidToHaveWhatCuttingLeaves) {
    std::mt19937_64 random(testSeed());
    std::array<std::size_t, 3> verdicts{};
    for (std::size_t round = 0; round < randomCases(100000, 10) && !HasFailure(); ++round) {
        const Corners corners = drawnCorners(random);
        const CertifiedTriangle triangle =
            triangleOf(corners, chance(random, 0.3) ? drawn(random, 0, 4.5e-4) : drawn(random, 0, 1e-4));
        const bool asked = TriangleCells::mayBeAsked(triangle);
        forCubes(corners, [&](const std::array<std::int32_t, 3>& first) {
            for (std::int32_t i = 0; i < kCubeCells; ++i) {
                const auto [x, y, z] = cellOfCube(first, i);
                const int verdict = shader::certifiedOverlap(triangle, x, y, z);
                if (verdict != CERTIFIED_UNDECIDED) {
                    EXPECT_TRUE(asked);
                    EXPECT_EQ(verdict == CERTIFIED_CERTAIN, cutLeavesSome(triangle, x, y, z))
                        << "round " << round << ", cell " << x << ", " << y << ", " << z;
                }
                verdicts[static_cast<std::size_t>(verdict)] += asked ? 1U : 0U;
            }
        });
    }
    std::cout << verdicts[CERTIFIED_CERTAIN] << " pass, " << verdicts[CERTIFIED_NONE] << " do not, "
              << verdicts[CERTIFIED_UNDECIDED] << " are unclear\n";
    EXPECT_GT(verdicts[CERTIFIED_CERTAIN], 10000U);
    EXPECT_LT(verdicts[CERTIFIED_UNDECIDED], verdicts[CERTIFIED_CERTAIN] / 4);
}

TEST(TriangleCellsTest, FewAreUnclear) {
    std::mt19937_64 random(testSeed());
    std::size_t some = 0;
    std::size_t unclear = 0;
    for (int round = 0; round < 2000; ++round) {
        Corners corners{};
        for (VoxelPoint& corner : corners) {
            corner = {drawn(random, 10, 16), drawn(random, 10, 16), drawn(random, 10, 16)};
        }
        const CertifiedTriangle triangle = triangleOf(corners, 1e-5F);
        ASSERT_TRUE(TriangleCells::mayBeAsked(triangle));
        const TriangleCells cells(triangle);
        forCubes(corners, [&](const std::array<std::int32_t, 3>& first) {
            const TriangleCells::Overlap overlap = cells.of(~TriangleCells::Bits{0}, first);
            some += static_cast<std::size_t>(std::popcount(overlap.some));
            unclear += kCubeCells - static_cast<std::size_t>(std::popcount(overlap.some | overlap.none));
        });
    }
    std::cout << some << " pass, " << unclear << " are unclear\n";
    EXPECT_LT(unclear, some / 100); // with a margin of 1/128 voxel a twentieth
}

/// What may be anywhere near, and what is large, is for others.
TEST(TriangleCellsTest, AreNotAskedOfWhatIsTooUncertain) {
    const Corners corners{{{1, 1, 1}, {4, 1, 2}, {2, 5, 3}}};
    EXPECT_TRUE(TriangleCells::mayBeAsked(triangleOf(corners, 1e-5F)));
    EXPECT_FALSE(TriangleCells::mayBeAsked(triangleOf(corners, 1e-3F)));
    EXPECT_FALSE(TriangleCells::mayBeAsked(triangleOf({{{0, 0, 0}, {1500, 1, 2}, {2, 5, 3}}}, 1e-5F)));
}

} // namespace
} // namespace voxtact::test
