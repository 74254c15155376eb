// SPDX-License-Identifier: MIT
#pragma once

#include "opacity_ranges.h"

namespace voxtact::cpu {

/// From where to where a table is opaque.
struct OpaqueHull {
    shader::OpacityBounds bounds;
    /// Every range that reaches from the first on and begins up to the last may be opaque, or nearly so: there is no
    /// hole.
    bool whole = false;
};

[[nodiscard]] OpaqueHull opaqueHullOf(const shader::OpacityTable& table) noexcept;

/// A table with its bounds, and whether its hull is whole.
struct OpacityLook {
    shader::OpacityTable table;
    bool whole = false;

    /// False only where certifiedMayBeOpaque() says so of the table.
    [[nodiscard]] bool mayBeOpaque(float lo, float hi, float error) const noexcept {
        const float below = lo - error;
        const float above = hi + error;
        if (above < table.bounds.first || below > table.bounds.last) {
            return false;
        }
        return whole || shader::mayBeOpaque(table, below, above);
    }
};

} // namespace voxtact::cpu
