// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <span>
#include <vector>

namespace voxtact {

/// Returns the control points that a table over a domain represents.
[[nodiscard]] inline std::vector<ControlPoint> pointsOf(std::span<const float> table, const ValueRange& domain) {
    std::vector<ControlPoint> points;
    const double width = (domain.hi - domain.lo) / static_cast<double>(table.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
        points.push_back({domain.lo + (static_cast<double>(i) + 0.5) * width, static_cast<double>(table[i])});
    }
    return points;
}

} // namespace voxtact
