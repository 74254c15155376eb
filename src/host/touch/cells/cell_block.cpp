// SPDX-License-Identifier: MIT
#include "host/touch/cells/cell_block.h"

namespace voxtact::cpu {

namespace {

/// Bits of the second cell along each axis.
constexpr unsigned kSecondX = 0xAA;
constexpr unsigned kSecondY = 0xCC;
constexpr unsigned kSecondZ = 0xF0;

/// Returns the bits of a block of a brick's cells that begins at `first`, numbered in the brick: from -1, because it
/// may begin in the brick before.
unsigned blockOf(const CellBits& bits, const std::array<std::int32_t, 3>& first) {
    unsigned found = 0;
    for (std::int32_t number = 0; number < 4; ++number) {
        const std::int32_t y = first[1] + number % 2;
        const std::int32_t z = first[2] + number / 2;
        if (y >= 0 && z >= 0 && y < kBrickSide && z < kBrickSide) {
            const unsigned row = bits[static_cast<std::size_t>(y + kBrickSide * z)];
            found |= (row << 1U >> static_cast<unsigned>(first[0] + 1) & 3U) << (2 * static_cast<unsigned>(number));
        }
    }
    return found;
}

/// Like blockOf(), for a block inside the brick.
unsigned blockWithin(const CellBits& bits, const CellBlock& block) {
    const std::size_t nextY = (block.cells & kSecondY) != 0 ? 1 : 0;
    const std::size_t nextZ = (block.cells & kSecondZ) != 0 ? kBrickSide : 0;
    const auto pair = [&](std::size_t row) { return unsigned{bits[row]} >> block.column & 3U; };
    return pair(block.row) | pair(block.row + nextY) << 2U | pair(block.row + nextZ) << 4U |
           pair(block.row + nextZ + nextY) << 6U;
}

} // namespace

BlockLookup::Known BlockLookup::find(const std::array<std::int32_t, 3>& brick) const {
    if (!occupancy_.mayBeOpaque(occupancy_.brickNumber(brick))) {
        return {};
    }
    return {&occupancy_.cells(volume_, brick).mayBeOpaque, &occupancy_.allOpaque(volume_, brick)};
}

BlockBits BlockLookup::ofOne(const CellBlock& block) {
    if (block.brick != brick_) {
        const auto brickOf = [&](std::size_t axis) { return (block.first[axis] + 1) >> kBrickShift; };
        known_ = find({brickOf(0), brickOf(1), brickOf(2)});
        brick_ = block.brick;
    }
    return known_.mayBeOpaque == nullptr
               ? BlockBits{}
               : BlockBits{blockWithin(*known_.mayBeOpaque, block), blockWithin(*known_.allOpaque, block)};
}

BlockBits BlockLookup::ofSeveral(const CellBlock& block) const {
    const auto second = [&](unsigned bits) { return (block.cells & bits) != 0 ? 1 : 0; };
    const CellBox cells{
        block.first,
        {block.first[0] + second(kSecondX), block.first[1] + second(kSecondY), block.first[2] + second(kSecondZ)}};
    const BrickBox bricks = cells.bricks();
    BlockBits bits;
    for (std::int32_t z = bricks.lo[2]; z <= bricks.hi[2]; ++z) {
        for (std::int32_t y = bricks.lo[1]; y <= bricks.hi[1]; ++y) {
            for (std::int32_t x = bricks.lo[0]; x <= bricks.hi[0]; ++x) {
                const Known known = find({x, y, z});
                if (known.mayBeOpaque != nullptr) {
                    const std::array<std::int32_t, 3> from{block.first[0] + 1 - (x << kBrickShift),
                                                           block.first[1] + 1 - (y << kBrickShift),
                                                           block.first[2] + 1 - (z << kBrickShift)};
                    bits.mayBeOpaque |= blockOf(*known.mayBeOpaque, from);
                    bits.allOpaque |= blockOf(*known.allOpaque, from);
                }
            }
        }
    }
    return bits;
}

} // namespace voxtact::cpu
