// SPDX-License-Identifier: MIT
// The bits of a brick's cells.
#include "cpu/certified/certified_bricks.h"

#include "cpu/scenes/random_scene.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace voxtact::test {
namespace {

using cpu::BrickCells;
using cpu::CellBox;
using cpu::kBrickSide;

/// Most bricks have few cells: a box misses them, or holds one in a single one of its rows.
BrickCells randomCells(std::mt19937_64& random) {
    BrickCells cells;
    for (std::size_t cell = below(random, 6); cell > 0; --cell) {
        cells.mayBeOpaque[below(random, cells.mayBeOpaque.size())] |=
            static_cast<std::uint8_t>(1U << below(random, kBrickSide));
    }
    return cells;
}

CellBox randomBox(std::mt19937_64& random) {
    CellBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto one = static_cast<std::int32_t>(below(random, kBrickSide));
        const auto other = static_cast<std::int32_t>(below(random, kBrickSide));
        box.lo[axis] = std::min(one, other);
        box.hi[axis] = std::max(one, other);
    }
    return box;
}

bool has(const BrickCells& cells, std::int32_t x, std::int32_t y, std::int32_t z) {
    return (cells.mayBeOpaque[static_cast<std::size_t>(y + kBrickSide * z)] >> static_cast<unsigned>(x) & 1U) != 0;
}

TEST(BrickCellsTest, ABoxHasSomeWhereOneOfItsCellsIs) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 20000; ++round) {
        const BrickCells cells = randomCells(random);
        const CellBox box = randomBox(random);
        bool expected = false;
        for (std::int32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
            for (std::int32_t y = box.lo[1]; y <= box.hi[1]; ++y) {
                unsigned row = 0;
                for (std::int32_t x = box.lo[0]; x <= box.hi[0]; ++x) {
                    row |= has(cells, x, y, z) ? 1U << static_cast<unsigned>(x) : 0U;
                }
                ASSERT_EQ(cells.row(box, y, z), row);
                expected = expected || row != 0;
            }
        }
        ASSERT_EQ(cells.any(box), expected);
    }
}

} // namespace
} // namespace voxtact::test
