// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/infinity.h"

#include <cstddef>
#include <span>
#include <vector>

namespace voxtact::cpu {

/// A closed interval of entry coordinates (shaders/opacity_ranges.h).
struct EntryInterval {
    double lo = -kInfinity;
    double hi = kInfinity;
};

/// Which entry coordinates are opaque: the table is linear between its entries and constant beyond them, so they are
/// some closed intervals, each known up to the rounding of a division.
class OpaqueIntervals {
  public:
    OpaqueIntervals() = default;
    /// `table` as sampleTable() returns it.
    OpaqueIntervals(std::span<const float> table, float threshold);

    /// Whether [lo, hi] may have an opaque coordinate. `hull` is then the least interval that certainly holds all of
    /// them that are in [lo, hi], but for ends that are beyond lo or hi. NaN may be anything.
    [[nodiscard]] bool meet(double lo, double hi, EntryInterval& hull) const noexcept;
    /// Some of them, one after the other.
    struct Some {
        std::span<const EntryInterval> outer; ///< they hold all that is opaque
        std::span<const EntryInterval> inner; ///< of each, what certainly is
        bool known = false;                   ///< false: there may be any
    };
    /// Those that have something in common with [lo, hi]; not known with NaN.
    [[nodiscard]] Some between(double lo, double hi) const noexcept;
    /// Whether all of [lo, hi] is certainly opaque. False with NaN.
    [[nodiscard]] bool contain(double lo, double hi) const noexcept;
    /// Whether some coordinate of [lo, hi] is certainly opaque. False for an empty range, and with NaN.
    [[nodiscard]] bool certainlyMeet(double lo, double hi) const noexcept;
    /// The interval nearest to a coordinate. Expects that there is one, and no NaN.
    [[nodiscard]] const EntryInterval& nearest(double entry) const noexcept;
    [[nodiscard]] bool empty() const noexcept { return outer_.empty(); }

  private:
    [[nodiscard]] std::size_t firstEndingAt(const std::vector<EntryInterval>& in, double lo) const noexcept;

    std::vector<EntryInterval> outer_; ///< ascending; they hold all that is opaque
    std::vector<EntryInterval> inner_; ///< ascending; all that they hold is opaque
};

} // namespace voxtact::cpu
