// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>
#include <span>
#include <vector>

namespace voxtact {

/// Storage of an image's values: value = slope * stored + intercept.
struct StoredScale {
    double slope = 1; ///< not 0
    double intercept = 0;
};

/// The stored values whose opacity reaches a threshold. Between control points the opacity is linear, beyond them
/// constant, so the opaque values are closed intervals. At a step (points of one value) the greatest opacity counts.
/// An end is exact where it is the value of a control point and a double; others are known up to a few roundings.
class OpaqueIntervals {
  public:
    OpaqueIntervals() = default;
    /// Expects points that checkPoints() accepts.
    OpaqueIntervals(std::span<const ControlPoint> points, double threshold, const StoredScale& stored = {});

    /// Ascending and disjoint; together they contain all opaque values.
    [[nodiscard]] std::span<const ValueRange> outer() const noexcept { return outer_; }
    /// Ascending and disjoint; they contain only opaque values.
    [[nodiscard]] std::span<const ValueRange> inner() const noexcept { return inner_; }

    /// Returns whether [lo, hi] may have an opaque value. `hull` is then the smallest interval that certainly contains
    /// all of those in [lo, hi], except for ends beyond lo or hi. NaN may be any value.
    [[nodiscard]] bool meet(double lo, double hi, ValueRange& hull) const noexcept;
    [[nodiscard]] bool mayMeet(double lo, double hi) const noexcept;
    /// Returns the intervals that meet [lo, hi].
    struct Some {
        std::span<const ValueRange> outer;
        std::span<const ValueRange> inner;
        bool known = false; ///< false for NaN: any value may be opaque
    };
    [[nodiscard]] Some between(double lo, double hi) const noexcept;
    /// Returns whether all of [lo, hi] is certainly opaque. False for NaN.
    [[nodiscard]] bool contain(double lo, double hi) const noexcept;
    /// Returns whether some value of [lo, hi] is certainly opaque. False for an empty range, and for NaN.
    [[nodiscard]] bool certainlyMeet(double lo, double hi) const noexcept;
    /// Returns the inner interval nearest to a value. Expects that there is one, and no NaN.
    [[nodiscard]] const ValueRange& nearest(double value) const noexcept;

  private:
    std::vector<ValueRange> outer_;
    std::vector<ValueRange> inner_;
};

} // namespace voxtact
