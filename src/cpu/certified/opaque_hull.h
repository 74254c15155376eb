// SPDX-License-Identifier: MIT
#pragma once

#include "opacity_ranges.h"

namespace voxtact::cpu {

/// From where to where a table is opaque.
struct OpaqueHull : shader::OpacityBounds {
    /// Every range that reaches from `first` on and begins up to `last` may be opaque, or nearly so: there is no hole.
    bool whole = false;
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
