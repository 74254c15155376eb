// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/judges/quad_place.h"
#include "voxtact/data.h"

#include <algorithm>
#include <span>

namespace voxtact::test::quad {

/// What is opaque by the control points: linear between them, constant beyond; at a step the greatest counts.
class Opaque {
  public:
    Opaque(std::span<const ControlPoint> points, double threshold) : points_(points), threshold_(threshold) {}

    /// Whether some of the values between may be opaque.
    template <class Real> [[nodiscard]] bool may(Real lo, Real hi) const {
        return beyond(lo, hi, true) || hasOpaquePoint(lo, hi) || onLines(lo, hi, [&](Real from, Real to) {
                   return std::max(from, to) >= Real(threshold_) - kOpacity<Real>;
               });
    }
    template <class Real> [[nodiscard]] bool allOf(Real lo, Real hi) const {
        if (lo == hi && hasOpaquePoint(lo, hi)) {
            return true;
        }
        return !beyond(lo, hi, false) && !onLines(lo, hi, [&](Real from, Real to) {
            return std::min(from, to) < Real(threshold_) + (from == to ? Real(0) : kOpacity<Real>);
        });
    }
    template <class Real> [[nodiscard]] bool someOf(Real lo, Real hi) const {
        return lo <= hi && (hasOpaquePoint(lo, hi) || allOf(lo, lo) || allOf(hi, hi));
    }

  private:
    template <class Real> static constexpr Real kOpacity = 8 * kRounding<Real>;

    /// Whether there are values beyond the points where the opacity reaches the threshold, or does not.
    template <class Real> [[nodiscard]] bool beyond(Real lo, Real hi, bool reaches) const {
        return (lo < Real(points_.front().value) && (points_.front().opacity >= threshold_) == reaches) ||
               (hi > Real(points_.back().value) && (points_.back().opacity >= threshold_) == reaches);
    }
    template <class Real> [[nodiscard]] bool hasOpaquePoint(Real lo, Real hi) const {
        return std::ranges::any_of(points_, [&](const ControlPoint& point) {
            return Real(point.value) >= lo && Real(point.value) <= hi && point.opacity >= threshold_;
        });
    }
    /// Whether `ask(from, to)` is true of the opacities at the ends of some line's part in the range.
    template <class Real, class Ask> [[nodiscard]] bool onLines(Real lo, Real hi, const Ask& ask) const {
        for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
            const Real from = Real(points_[i].value);
            const Real to = Real(points_[i + 1].value);
            if (!(from < to) || from > hi || to < lo) {
                continue;
            }
            const Real first = Real(points_[i].opacity);
            const Real rise = Real(points_[i + 1].opacity) - first;
            const auto at = [&](Real value) {
                return value <= from ? first
                       : value >= to ? Real(points_[i + 1].opacity)
                                     : first + rise * ((value - from) / (to - from));
            };
            if (ask(at(lo), at(hi))) {
                return true;
            }
        }
        return false;
    }

    std::span<const ControlPoint> points_;
    double threshold_;
};

} // namespace voxtact::test::quad
