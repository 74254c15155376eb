// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/judges/quad_place.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voxtact::test::quad {

/// What is opaque by the table.
class Opaque {
  public:
    Opaque(std::span<const float> table, float threshold) : table_(table), threshold_(threshold), before_{0} {
        for (const float entry : table) {
            before_.push_back(before_.back() + (entry >= threshold ? 1 : 0));
        }
    }

    /// Whether some of the coordinates between may be opaque; of the table's, entry i being at i.
    template <class Real> [[nodiscard]] bool may(Real lo, Real hi) const {
        const Real from = clamped(lo);
        const Real to = clamped(hi);
        if (among(below(from), above(to)) == 0) {
            return false;
        }
        return some(from, to) || at(from) >= Real(threshold_) - kTable<Real> ||
               at(to) >= Real(threshold_) - kTable<Real>;
    }
    template <class Real> [[nodiscard]] bool allOf(Real lo, Real hi) const {
        const Real from = clamped(lo);
        const Real to = clamped(hi);
        const std::int64_t first = below(from);
        const std::int64_t last = above(to);
        if (among(first, last) == last - first + 1) {
            return true;
        }
        const std::int64_t inner = above(from);
        const std::int64_t outer = below(to);
        return (inner > outer || among(inner, outer) == outer - inner + 1) && surely(from) && surely(to);
    }
    template <class Real> [[nodiscard]] bool someOf(Real lo, Real hi) const {
        if (!(lo <= hi)) {
            return false;
        }
        const Real from = clamped(lo);
        const Real to = clamped(hi);
        return some(from, to) || surely(from) || surely(to);
    }

  private:
    template <class Real> static constexpr Real kTable = 8 * kRounding<Real>;

    template <class Real> [[nodiscard]] Real clamped(Real x) const {
        const Real last = Real(static_cast<double>(table_.size() - 1));
        return x > 0 ? (x < last ? x : last) : Real(0);
    }
    template <class Real> [[nodiscard]] static std::int64_t below(Real x) { return static_cast<std::int64_t>(x); }
    template <class Real> [[nodiscard]] static std::int64_t above(Real x) {
        const std::int64_t cut = below(x);
        return Real(static_cast<double>(cut)) < x ? cut + 1 : cut;
    }
    /// Opaque entries from `first` to `last`.
    [[nodiscard]] std::int64_t among(std::int64_t first, std::int64_t last) const {
        return before_[static_cast<std::size_t>(last + 1)] - before_[static_cast<std::size_t>(first)];
    }
    template <class Real> [[nodiscard]] bool some(Real from, Real to) const {
        return above(from) <= below(to) && among(above(from), below(to)) > 0;
    }
    template <class Real> [[nodiscard]] Real at(Real x) const {
        const auto first = static_cast<std::size_t>(below(x));
        const auto second = static_cast<std::size_t>(above(x));
        const Real a = Real(table_[first]);
        return a + (x - Real(static_cast<double>(first))) * (Real(table_[second]) - a);
    }
    template <class Real> [[nodiscard]] bool surely(Real x) const {
        const std::int64_t first = below(x);
        const std::int64_t last = above(x);
        return among(first, last) == last - first + 1 || at(x) >= Real(threshold_) + kTable<Real>;
    }

    std::span<const float> table_;
    float threshold_;
    std::vector<std::int64_t> before_;
};

} // namespace voxtact::test::quad
