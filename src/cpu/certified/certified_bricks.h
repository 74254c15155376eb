// SPDX-License-Identifier: MIT
#pragma once

#include "certified.h"
#include "cpu/raster/brick_sums.h"
#include "cpu/scene/scene_impl.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace voxtact::cpu {

/// Cells of a brick's side.
inline constexpr std::int32_t kBrickSide = 1 << kBrickShift;

/// A box of cells, both ends inclusive, numbered from -1.
struct CellBox {
    std::array<std::int32_t, 3> lo{};
    std::array<std::int32_t, 3> hi{};

    [[nodiscard]] bool empty() const noexcept { return hi[0] < lo[0] || hi[1] < lo[1] || hi[2] < lo[2]; }
    [[nodiscard]] bool single() const noexcept { return hi == lo; }
    [[nodiscard]] BrickBox bricks() const noexcept {
        BrickBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = (lo[axis] + 1) >> kBrickShift;
            box.hi[axis] = (hi[axis] + 1) >> kBrickShift;
        }
        return box;
    }
    /// Those of them that are in a brick, numbered within it from 0. Expects one of bricks().
    [[nodiscard]] CellBox within(const std::array<std::int32_t, 3>& brick) const noexcept {
        CellBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int32_t first = (brick[axis] << kBrickShift) - 1;
            box.lo[axis] = std::max(lo[axis] - first, 0);
            box.hi[axis] = std::min(hi[axis] - first, kBrickSide - 1);
        }
        return box;
    }
};

/// What is known of a brick's cells under a transfer function and threshold.
struct BrickCells {
    /// Stored values near the brick: of its cells, and of those one farther out on every side.
    float wideLo = 0;
    float wideHi = 0;
    /// A bit for each cell that may have an opaque point (certifiedCellMayBeOpaque()): bit x of [y + 8 * z].
    std::array<std::uint8_t, kBrickSide * kBrickSide> mayBeOpaque{};
    /// The box around these cells, numbered within the brick.
    CellBox around{{kBrickSide, kBrickSide, kBrickSide}, {-1, -1, -1}};

    /// The bits of a row of cells, of those between the columns of a box (numbered within the brick).
    [[nodiscard]] unsigned row(const CellBox& box, std::int32_t y, std::int32_t z) const noexcept {
        const unsigned columns = (2U << static_cast<unsigned>(box.hi[0])) - (1U << static_cast<unsigned>(box.lo[0]));
        return mayBeOpaque[static_cast<std::size_t>(y + kBrickSide * z)] & columns;
    }
    /// Whether some cell of a box (numbered within the brick) may have an opaque point.
    [[nodiscard]] bool any(const CellBox& box) const noexcept;
    /// The bits of a slice: row y from bit 8 * y on.
    [[nodiscard]] std::uint64_t slice(std::int32_t z) const noexcept;
};
static_assert(kBrickSide == 8, "a row of cells is a byte");

/// The cells of the bricks that may have an opaque point, each brick's made when it is first asked for.
/// Thread-safe.
class CertifiedBricks {
  public:
    CertifiedBricks() = default;
    /// `mixed` is not zero for the bricks that may be asked for.
    explicit CertifiedBricks(std::span<const std::uint8_t> mixed);

    /// Of a brick that may be asked for, given by its number and its place; with the same volume, item and table in
    /// every call.
    [[nodiscard]] const BrickCells& at(const VolumeImpl& volume, const shader::CertifiedItem& item,
                                       const shader::OpacityTable& table, std::size_t number,
                                       const std::array<std::int32_t, 3>& place) const {
        const std::uint32_t slot = slots_[number];
        if (!made_[slot].load(std::memory_order_acquire)) {
            make(volume, item, table, slot, place);
        }
        return cells_[slot];
    }

  private:
    void make(const VolumeImpl& volume, const shader::CertifiedItem& item, const shader::OpacityTable& table,
              std::uint32_t slot, const std::array<std::int32_t, 3>& place) const;

    std::vector<std::uint32_t> slots_; ///< by brick
    std::unique_ptr<std::atomic<bool>[]> made_;
    std::unique_ptr<BrickCells[]> cells_;
    std::unique_ptr<std::mutex> mutex_;
};

} // namespace voxtact::cpu
