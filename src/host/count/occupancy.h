// SPDX-License-Identifier: MIT
#pragma once

#include "host/count/brick_sums.h"
#include "host/count/opaque_set.h"
#include "host/scene/scene_impl.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// Bits of a brick: 0, it may have an opaque sample; 1, all of its samples are opaque.
enum BrickClass : std::uint8_t { kClearBrick = 0, kMixedBrick = 1, kOpaqueBrick = 3 };

/// One volume under one transfer function and threshold.
class Occupancy {
  public:
    Occupancy(const VolumeImpl& volume, const TransferFunctionImpl& function, double threshold);

    /// One byte per brick, x fastest, and a few more: a lookup reads four.
    [[nodiscard]] const std::uint8_t* classes() const noexcept { return classes_.data(); }
    /// Merges the bits of a box's bricks with eight lookups.
    [[nodiscard]] BrickClass within(const BrickBox& box) const noexcept;
    /// Returns true if no sample of the volume is opaque.
    [[nodiscard]] bool nothingOpaque() const noexcept;
    /// The opaque stored values; without useIntervals() the table decides.
    [[nodiscard]] std::span<const Interval> intervals() const noexcept { return set_.intervals(); }
    [[nodiscard]] bool useIntervals() const noexcept { return useIntervals_; }
    [[nodiscard]] const std::vector<float>& table() const noexcept { return table_; }
    [[nodiscard]] const shader::ItemConstants& constants() const noexcept { return constants_; }

  private:
    void classify(const BrickRanges& ranges);

    std::array<std::int32_t, 3> count_;
    shader::ItemConstants constants_;
    std::vector<float> table_;
    OpaqueSet set_;
    bool useIntervals_ = false;
    std::vector<std::uint8_t> classes_;
    BrickSums<std::uint64_t> sums_; ///< bricks that may have an opaque sample in the low half, certain ones in the high
};

} // namespace voxtact::cpu
