// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace voxtact {

/// a - b, where that is a double: by the error of Knuth's TwoSum.
[[nodiscard]] inline std::optional<double> exactDifference(double a, double b) noexcept {
    const double difference = a - b;
    const double back = difference - a;
    const double error = (a - (difference - back)) - (b + back);
    return error == 0 ? std::optional(difference) : std::nullopt;
}

} // namespace voxtact
