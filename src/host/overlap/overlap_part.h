// SPDX-License-Identifier: MIT
#pragma once

#include "host/overlap/box_part.h"

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

namespace voxtact::cpu {

/// Opaque volumes of a brick's cells, each computed at first use. Thread-safe.
class BrickVolumes {
  public:
    static constexpr std::size_t kCells = std::size_t{1} << (3 * kBrickShift);

    BrickVolumes() {
        for (std::atomic<std::uint64_t>& one : known_) {
            one.store(kUnset, std::memory_order_relaxed);
        }
    }
    /// `make()` returns the same in every call for a place.
    template <class Make> [[nodiscard]] ValueRange get(std::size_t place, const Make& make) const {
        std::uint64_t bits = known_[place].load(std::memory_order_relaxed);
        if (bits == kUnset) {
            const std::array<float, 2> made = make();
            bits = std::bit_cast<std::uint64_t>(made);
            known_[place].store(bits, std::memory_order_relaxed);
        }
        const auto both = std::bit_cast<std::array<float, 2>>(bits);
        return {static_cast<double>(both[0]), static_cast<double>(both[1])};
    }

  private:
    static constexpr std::uint64_t kUnset = ~std::uint64_t{0}; ///< NaN

    mutable std::array<std::atomic<std::uint64_t>, kCells> known_;
};

/// One volume under one transfer function and threshold, with the opaque volume of each cell, for all poses.
/// Thread-safe.
class OverlapPart {
  public:
    enum class Kind : std::uint8_t { Clear, Mixed, Opaque };

    OverlapPart(const VolumeImpl& volume, const TransferFunctionImpl& function, double threshold);

    [[nodiscard]] Kind kind(std::size_t brick) const noexcept { return kinds_[brick]; }
    [[nodiscard]] static NodePlace brickOf(const NodePlace& cell) noexcept {
        return {cell[0] >> kBrickShift, cell[1] >> kBrickShift, cell[2] >> kBrickShift};
    }
    /// Opaque part of a cell: none, all, or some.
    [[nodiscard]] Kind kind(const VolumeImpl& volume, const NodePlace& cell) const;
    /// In voxels, for a mixed cell; the higher the level, the nearer are the bounds. `gain` is set where the next level
    /// may bring them nearer. `volume` is the one of the constructor, here and above.
    [[nodiscard]] BoxVolume cell(const VolumeImpl& volume, const NodePlace& cell, unsigned level) const;

    /// Whether cells of this level are measured once for all poses.
    [[nodiscard]] static constexpr bool isKept(unsigned level) noexcept { return level < kKeptLevels; }
    /// Estimated number of boxes of this level.
    [[nodiscard]] static std::uint64_t boxesOf(unsigned level) noexcept { return std::uint64_t{4} << (4 * level); }
    /// Returns true if a brick outside the box certainly contains an opaque point.
    [[nodiscard]] bool isCertainOutside(const VolumeImpl& volume, const BrickBox& box) const;

    OpaquePart part;

  private:
    static constexpr unsigned kKeptLevels = 2;

    [[nodiscard]] static std::size_t placeOf(const NodePlace& cell) noexcept {
        constexpr std::int32_t kMask = (1 << kBrickShift) - 1;
        return static_cast<std::size_t>(((cell[2] & kMask) << (2 * kBrickShift)) + ((cell[1] & kMask) << kBrickShift) +
                                        (cell[0] & kMask));
    }
    std::vector<Kind> kinds_;
    std::array<MadeOnce<std::shared_ptr<const BrickVolumes>>, kKeptLevels> volumes_;
    std::vector<std::uint32_t> slots_; ///< by brick
};

} // namespace voxtact::cpu
