// SPDX-License-Identifier: MIT
#pragma once

#include "exact/shared.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voxtact::cpu {

/// A closed interval of stored values.
struct Interval {
    float lo = 0;
    float hi = 0;
};

/// The stored values that are opaque in the exact arithmetic, as disjoint ascending intervals: exactly those floats, no
/// margin. Every step of exactEntry(), and exactLerp() between two entries, is monotonic in its argument also after
/// rounding, so that within one entry of the table the verdict changes at most once.
class OpaqueSet {
  public:
    /// `constants` as itemConstants() makes them for stored values.
    OpaqueSet(std::span<const float> table, const shader::ItemConstants& constants);

    /// False if the constants overflow a float; the intervals must then not be used.
    [[nodiscard]] bool valid() const noexcept { return valid_; }
    [[nodiscard]] std::span<const Interval> intervals() const noexcept { return intervals_; }
    /// Returns true if some value of a closed range is opaque. Expects valid().
    [[nodiscard]] bool meets(float lo, float hi) const noexcept;
    /// Returns true if all values of a closed range are opaque. Expects valid().
    [[nodiscard]] bool contains(float lo, float hi) const noexcept;

  private:
    [[nodiscard]] const Interval* lastFrom(float value) const noexcept;

    std::vector<Interval> intervals_;
    bool valid_ = false;
};

/// The verdict on one stored value.
[[nodiscard]] float opacityOf(std::span<const float> table, const shader::ItemConstants& constants,
                              float stored) noexcept;
[[nodiscard]] bool isOpaque(std::span<const float> table, const shader::ItemConstants& constants,
                            float stored) noexcept;

} // namespace voxtact::cpu
