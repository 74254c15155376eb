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

/// What is known of a brick's cells under a transfer function and threshold.
struct BrickCells {
    /// Stored values near the brick: of its cells, and of those one farther out on every side.
    float wideLo = 0;
    float wideHi = 0;
    /// The cells that may have an opaque point (certifiedCellMayBeOpaque()).
    CellBits mayBeOpaque{};
    /// The box around these cells, numbered within the brick.
    CellBox around{{kBrickSide, kBrickSide, kBrickSide}, {-1, -1, -1}};

    /// The bits of a row of cells, of those between the columns of a box (numbered within the brick).
    [[nodiscard]] unsigned row(const CellBox& box, std::int32_t y, std::int32_t z) const noexcept {
        return mayBeOpaque[static_cast<std::size_t>(y + kBrickSide * z)] & box.columns();
    }
    /// Whether a cell of the brick, numbered as the volume's, may have an opaque point.
    [[nodiscard]] bool has(const std::array<std::int32_t, 3>& cell) const noexcept {
        const auto place = [&](std::size_t axis) {
            return static_cast<unsigned>(cell[axis] + 1) % static_cast<unsigned>(kBrickSide);
        };
        return (mayBeOpaque[place(1) + kBrickSide * place(2)] >> place(0) & 1U) != 0;
    }
    /// Whether some cell of a box (numbered within the brick) may have an opaque point.
    [[nodiscard]] bool any(const CellBox& box) const noexcept;
    /// The bits of a slice: row y from bit 8 * y on.
    [[nodiscard]] std::uint64_t slice(std::int32_t z) const noexcept;
};
/// Some values, each made when it is first asked for. Thread-safe.
template <class Value> class MadeOnce {
  public:
    MadeOnce() = default;
    explicit MadeOnce(std::size_t count)
        : count_(count), made_(std::make_unique<std::atomic<bool>[]>(count)), mutex_(std::make_unique<std::mutex>()) {}

    /// Null: it was not made yet.
    [[nodiscard]] const Value* find(std::size_t number) const noexcept {
        return made_[number].load(std::memory_order_acquire) ? &values_[number] : nullptr;
    }
    /// Of two threads that have made one at once, the first keeps it.
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

/// The cells of the bricks that may have an opaque point, each brick's made when it is first asked for.
/// Thread-safe.
class CertifiedBricks {
  public:
    CertifiedBricks() = default;
    /// `mixed` is not zero for the bricks that may be asked for.
    explicit CertifiedBricks(std::span<const std::uint8_t> mixed);

    /// Of a brick that may be asked for, given by its number and its place; with the same volume, item and opaque
    /// values in every call.
    [[nodiscard]] const BrickCells& at(const VolumeImpl& volume, const shader::CertifiedItem& item,
                                       const shader::OpaqueValues& opaque, std::size_t number,
                                       const std::array<std::int32_t, 3>& place) const {
        const BrickCells* made = cells_.find(slots_[number]);
        return made != nullptr ? *made : makeCells(volume, item, opaque, number, place);
    }
    /// Its cells that are in the domain and opaque all over: certifiedCellAllOpaque() says so of them for every
    /// triangle that is displaced by TriangleCells::kMostDelta at most.
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
