// SPDX-License-Identifier: MIT
#pragma once

#include "host/area/cell_part.h"
#include "voxtact/area.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

/// Neumaier's sum, which compensates rounding ("Rundungsfehleranalyse einiger Verfahren zur Summation endlicher
/// Summen", 1974).
class KeptSum {
  public:
    void add(double term) noexcept {
        const double next = sum_ + term;
        rest_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
        sum_ = next;
        magnitudes_ += std::abs(term);
        ++count_;
    }
    [[nodiscard]] double value() const noexcept { return sum_ + rest_; }
    /// Upper bound of the error: rounding of the sum and of `rest_`.
    [[nodiscard]] double error() const noexcept {
        const double twice = kRounding * count_;
        return 4 * (kRounding * std::abs(value()) + twice * twice * magnitudes_);
    }

  private:
    static constexpr double kRounding = 0x1p-53;
    double sum_ = 0;
    double rest_ = 0;
    double magnitudes_ = 0;
    double count_ = 0;
};

/// Sum over parts.
class AreaSum {
  public:
    void add(const PartArea& area) noexcept {
        lo_.add(area.lo);
        hi_.add(area.hi);
    }
    /// Removes one that was added, before its parts follow.
    void takeBack(const PartArea& area) noexcept {
        lo_.add(-area.lo);
        hi_.add(-area.hi);
    }
    [[nodiscard]] Bounds bounds() const noexcept {
        return {std::max(lo_.value() - lo_.error() - kPartError * std::abs(lo_.value()), 0.0),
                std::max(hi_.value() + hi_.error() + kPartError * std::abs(hi_.value()), 0.0)};
    }
    [[nodiscard]] bool within(double tolerance) const noexcept {
        const Bounds now = bounds();
        return now.upper - now.lower <= tolerance;
    }

  private:
    /// Relative error of each part: some products of the bounds in area_frame.h and uv_polygon.h.
    static constexpr double kPartError = 0x1p-46;

    KeptSum lo_;
    KeptSum hi_;
};

} // namespace voxtact::cpu
