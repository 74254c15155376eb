// SPDX-License-Identifier: MIT
#pragma once

#include "host/touch/cells/certified_occupancy.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace voxtact::cpu {

/// Cells that are no more than two along each axis, each with a bit: that of number x + 2 y + 4 z from the first one.
struct CellBlock {
    static constexpr std::size_t kMost = 8;

    std::array<std::int32_t, 3> first{};
    unsigned cells = 0; ///< those that are in it
    // Position of the first cell: the index of its brick, its row there (y + kBrickSide z), and its column; and whether
    // all others are in the same brick.
    std::uint32_t brick = 0;
    std::uint32_t row = 0;
    std::uint32_t column = 0;
    bool oneBrick = true;

    [[nodiscard]] std::array<std::int32_t, 3> at(unsigned number) const noexcept {
        return {first[0] + static_cast<std::int32_t>(number & 1U),
                first[1] + static_cast<std::int32_t>(number >> 1U & 1U),
                first[2] + static_cast<std::int32_t>(number >> 2U)};
    }
};

/// Occupancy of the cells of a block.
struct BlockBits {
    unsigned mayBeOpaque = 0; ///< somewhere
    unsigned allOpaque = 0;   ///< of these
};

/// Looks up the occupancy of blocks. Not thread-safe.
class BlockLookup {
  public:
    /// Both must outlive it.
    BlockLookup(const VolumeImpl& volume, const CertifiedOccupancy& occupancy) noexcept
        : volume_(volume), occupancy_(occupancy) {}

    /// Returns the occupancy of a block in the domain.
    [[nodiscard]] BlockBits at(const CellBlock& block) {
        BlockBits bits = block.oneBrick ? ofOne(block) : ofSeveral(block);
        bits.mayBeOpaque &= block.cells;
        bits.allOpaque &= bits.mayBeOpaque;
        return bits;
    }

  private:
    /// A brick's cells; null where none may have an opaque point.
    struct Known {
        const CellBits* mayBeOpaque = nullptr;
        const CellBits* allOpaque = nullptr;
    };

    [[nodiscard]] Known find(const std::array<std::int32_t, 3>& brick) const;
    /// Bits of cells outside the block are arbitrary.
    [[nodiscard]] BlockBits ofOne(const CellBlock& block);
    [[nodiscard]] BlockBits ofSeveral(const CellBlock& block) const;

    const VolumeImpl& volume_;
    const CertifiedOccupancy& occupancy_;                             ///< of that
    std::uint32_t brick_ = std::numeric_limits<std::uint32_t>::max(); ///< that ofOne() had last
    Known known_;                                                     ///< of that
};

/// Counts the set bits. Some processors lack an instruction for it.
[[nodiscard]] constexpr unsigned bitsIn(std::uint64_t bits) noexcept {
    bits -= bits >> 1U & 0x5555555555555555U;
    bits = (bits & 0x3333333333333333U) + (bits >> 2U & 0x3333333333333333U);
    bits = (bits + (bits >> 4U)) & 0x0F0F0F0F0F0F0F0FU;
    return static_cast<unsigned>(bits * 0x0101010101010101U >> 56U);
}

} // namespace voxtact::cpu
