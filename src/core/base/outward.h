// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace voxtact {

/// A lower or an upper bound to so many parts of a whole: what was one still is.
[[nodiscard]] inline double lowerRounded(double value, double parts) {
    return std::floor(value * parts) / parts;
}

[[nodiscard]] inline double upperRounded(double value, double parts) {
    return std::ceil(value * parts) / parts;
}

} // namespace voxtact
