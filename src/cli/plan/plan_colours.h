// SPDX-License-Identifier: MIT
#pragma once

#include "cli/draw/viridis.h"
#include "voxtact/plan.h"

#include <cmath>
#include <limits>

namespace voxtact::app {

/// Returns the colour of a path: unsafe red, undecided grey, safe by its distance.
[[nodiscard]] inline Rgb planColour(const PlannedPath& path, double maximum) {
    constexpr Rgb kUnsafe{178, 34, 34};
    constexpr Rgb kPossible{128, 128, 128};
    return path.safety == Safety::Unsafe      ? kUnsafe
           : path.safety == Safety::Undecided ? kPossible
                                              : viridis(path.clearance.lower / maximum);
}

/// Returns the largest float not above `value`.
[[nodiscard]] inline float roundedDown(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest > value ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}

/// Orders safe paths: the larger distance first, then the shorter path.
[[nodiscard]] inline bool isBetter(const PlannedPath& a, const PlannedPath& b) {
    return a.clearance.lower != b.clearance.lower ? a.clearance.lower > b.clearance.lower : a.length < b.length;
}

} // namespace voxtact::app
