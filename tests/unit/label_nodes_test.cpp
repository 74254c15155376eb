// SPDX-License-Identifier: MIT
// Which labels the nodes of a label map may have, against what each voxel says of the cells that it is a corner of.
#include "core/volume/label_nodes.h"
#include "support/scenes.h"
#include "support/take.h"

#include "brick_levels.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace voxtact::test {
namespace {

/// Of a node of so many cells per side, from a padded cell on: the numbers of the voxels that are corners of these.
std::set<std::uint32_t> numbersOf(const LabelData& labels, const std::array<int, 3>& first, int side) {
    std::set<std::uint32_t> found;
    const auto size = [&](std::size_t axis) { return static_cast<int>(labels.grid.size[axis]); };
    // Padded cell i has the voxels i - 1 and i.
    for (int z = std::max(first[2] - 1, 0); z <= std::min(first[2] + side - 1, size(2) - 1); ++z) {
        for (int y = std::max(first[1] - 1, 0); y <= std::min(first[1] + side - 1, size(1) - 1); ++y) {
            for (int x = std::max(first[0] - 1, 0); x <= std::min(first[0] + side - 1, size(0) - 1); ++x) {
                found.insert(labels.indices[static_cast<std::size_t>((z * size(1) + y) * size(0) + x)]);
            }
        }
    }
    return found;
}

TEST(LabelNodes, HaveTheLabelsOfTheirCorners) {
    std::mt19937_64 random(testSeed());
    for (const std::array<std::uint32_t, 3>& size :
         {std::array<std::uint32_t, 3>{1, 1, 1}, {7, 8, 9}, {16, 15, 17}, {33, 9, 24}}) {
        Grid grid;
        grid.size = size;
        // Few voxels have a label, so that most nodes lack most; some numbers are alike modulo 128.
        const LabelData labels =
            take(makeLabels(makeBytes(grid, [&](auto...) {
                                return random() % 40 == 0 ? static_cast<double>(random() % 200) : 0.0;
                            }).view()));
        const std::vector<LabelBits> nodes = labelNodes(labels);
        EXPECT_EQ(nodes.size(), labelNodeCount(grid));
        const auto sizeOf = [&](std::size_t axis) { return static_cast<int>(size[axis]); };
        std::size_t number = 0;
        for (int level = 0; level < shader::brickLevels(sizeOf(0), sizeOf(1), sizeOf(2)); ++level) {
            const shader::BrickLevel of = shader::brickLevel(sizeOf(0), sizeOf(1), sizeOf(2), level);
            ASSERT_EQ(static_cast<std::size_t>(of.first), number);
            const int side = 1 << (VOXTACT_BRICK_SHIFT + VOXTACT_LEVEL_SHIFT * level);
            for (int z = 0; z < of.countZ; ++z) {
                for (int y = 0; y < of.countY; ++y) {
                    for (int x = 0; x < of.countX; ++x, ++number) {
                        LabelBits expected{};
                        for (const std::uint32_t label : numbersOf(labels, {x * side, y * side, z * side}, side)) {
                            expected[label % VOXTACT_LABEL_BITS / 32] |= 1U << label % 32;
                        }
                        ASSERT_EQ(nodes[number], expected) << "level " << level << ", " << x << " " << y << " " << z;
                    }
                }
            }
        }
        EXPECT_EQ(number, nodes.size());
    }
}

} // namespace
} // namespace voxtact::test
