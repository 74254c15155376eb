// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

namespace voxtact::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

} // namespace voxtact::test
