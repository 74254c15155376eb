// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

namespace voxtact {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace voxtact
