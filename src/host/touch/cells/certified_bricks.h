// SPDX-License-Identifier: MIT
#pragma once

#include "exact/certified.h"
#include "host/scene/scene_impl.h"
#include "host/touch/cells/corner_ranges.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace voxtact::cpu {

/// Occupancy of a brick's cells under a transfer function and threshold.
struct BrickCells {
    /// Range of stored values near the brick: of its cells and their neighbours.
    float wideLo = 0;
    float wideHi = 0;
    /// The cells that may have an opaque point (certifiedCellMayBeOpaque()).
    CellBits mayBeOpaque{};
    /// The box around these cells, numbered within the brick.
    CellBox around{{kBrickSide, kBrickSide, kBrickSide}, {-1, -1, -1}};

    /// Returns the bits of a row of cells, between the columns of a box (numbered in the brick).
    [[nodiscard]] unsigned row(const CellBox& box, std::int32_t y, std::int32_t z) const noexcept {
        return mayBeOpaque[static_cast<std::size_t>(y + kBrickSide * z)] & box.columns();
    }
    /// Returns true if a cell of the brick, numbered in the volume, may have an opaque point.
    [[nodiscard]] bool has(const std::array<std::int32_t, 3>& cell) const noexcept {
        const auto place = [&](std::size_t axis) {
            return static_cast<unsigned>(cell[axis] + 1) % static_cast<unsigned>(kBrickSide);
        };
        return (mayBeOpaque[place(1) + kBrickSide * place(2)] >> place(0) & 1U) != 0;
    }
    /// Returns true if some cell of a box (numbered in the brick) may have an opaque point.
    [[nodiscard]] bool any(const CellBox& box) const noexcept;
    /// The bits of a slice: row y from bit 8 * y on.
    [[nodiscard]] std::uint64_t slice(std::int32_t z) const noexcept;
};
/// Values, each computed at first use. Thread-safe.
template <class Value> class MadeOnce {
  public:
    MadeOnce() = default;
    explicit MadeOnce(std::size_t count)
        : count_(count), made_(std::make_unique<std::atomic<bool>[]>(count)), mutex_(std::make_unique<std::mutex>()) {}

    /// Null: it was not made yet.
    [[nodiscard]] const Value* find(std::size_t number) const noexcept {
        return made_[number].load(std::memory_order_acquire) ? &values_[number] : nullptr;
    }
    /// If two threads create one at once, the first is kept.
    const Value& keep(std::size_t number, const Value& made) const {
        const std::lock_guard lock(*mutex_);
        if (values_ == nullptr) {
            values_ = std::make_unique<Value[]>(count_);
        }
        if (!made_[number].load(std::memory_order_relaxed)) {
            values_[number] = made;
            made_[number].store(true, std::memory_order_release);
        }
        return values_[number];
    }

  private:
    std::size_t count_ = 0;
    std::unique_ptr<std::atomic<bool>[]> made_;
    mutable std::unique_ptr<Value[]> values_; ///< null until there is one
    std::unique_ptr<std::mutex> mutex_;
};

/// The cells of the bricks that may have an opaque point, computed per brick at first use. Thread-safe.
class CertifiedBricks {
  public:
    CertifiedBricks() = default;
    /// `mixed` is not zero for the queried bricks.
    explicit CertifiedBricks(std::span<const std::uint8_t> mixed);

    /// Returns the cells of a brick, given by index and position; volume, item and opaque values must be the same in
    /// every call.
    [[nodiscard]] const BrickCells& at(const VolumeImpl& volume, const shader::CertifiedItem& item,
                                       const shader::OpaqueValues& opaque, std::size_t number,
                                       const std::array<std::int32_t, 3>& place) const {
        const BrickCells* made = cells_.find(slots_[number]);
        return made != nullptr ? *made : makeCells(volume, item, opaque, number, place);
    }
    /// Returns its cells in the domain that are entirely opaque: certifiedCellAllOpaque() holds for every triangle
    /// displaced by at most TriangleCells::kMostDelta.
    [[nodiscard]] const CellBits& allOpaqueAt(const VolumeImpl& volume, const shader::CertifiedItem& item,
                                              const shader::OpaqueValues& opaque, std::size_t number,
                                              const std::array<std::int32_t, 3>& place) const {
        const CellBits* made = allOpaque_.find(slots_[number]);
        return made != nullptr ? *made : makeAllOpaque(volume, item, opaque, number, place);
    }

  private:
    const BrickCells& makeCells(const VolumeImpl& volume, const shader::CertifiedItem& item,
                                const shader::OpaqueValues& opaque, std::size_t number,
                                const std::array<std::int32_t, 3>& place) const;
    const CellBits& makeAllOpaque(const VolumeImpl& volume, const shader::CertifiedItem& item,
                                  const shader::OpaqueValues& opaque, std::size_t number,
                                  const std::array<std::int32_t, 3>& place) const;

    std::vector<std::uint32_t> slots_; ///< by brick
    MadeOnce<BrickCells> cells_;
    MadeOnce<CellBits> allOpaque_;
};

} // namespace voxtact::cpu
