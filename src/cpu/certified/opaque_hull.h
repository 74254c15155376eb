// SPDX-License-Identifier: MIT
#pragma once

#include "opacity_ranges.h"

#include <limits>

namespace voxtact::cpu {

/// From where to where a table is opaque, in entry coordinates: what takes some look-ups to ask of a range, for most
/// ranges takes two comparisons.
struct OpaqueHull {
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    /// No range that ends before `first` or begins after `last` may be opaque, nor any part of one (mayBeOpaque()).
    float first = kInfinity;
    float last = -kInfinity;
    /// Every range that does neither may be, or nearly so: there is no hole.
    bool whole = false;
    /// Every range within these certainly is opaque all over (certainlyAllOpaque()). Empty: no such range is known.
    float allFirst = kInfinity;
    float allLast = -kInfinity;
};

[[nodiscard]] OpaqueHull opaqueHullOf(const shader::OpacityTable& table) noexcept;

/// A table, and its hull.
struct OpacityLook {
    shader::OpacityTable table;
    OpaqueHull hull;

    /// False only where certifiedMayBeOpaque() says so of the table.
    [[nodiscard]] bool mayBeOpaque(float lo, float hi, float error) const noexcept {
        const float below = lo - error;
        const float above = hi + error;
        if (above < hull.first || below > hull.last) {
            return false;
        }
        return hull.whole || shader::mayBeOpaque(table, below, above);
    }
};

} // namespace voxtact::cpu
