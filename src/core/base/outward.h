// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace voxtact {

/// Widens a lower or upper bound relatively; the result is still a bound.
[[nodiscard]] inline double lowerRounded(double value, double parts) {
    return std::floor(value * parts) / parts;
}

[[nodiscard]] inline double upperRounded(double value, double parts) {
    return std::ceil(value * parts) / parts;
}

} // namespace voxtact
