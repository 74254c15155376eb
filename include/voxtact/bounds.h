// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cstdint>

/// Bounds of a measured quantity.
namespace voxtact {

/// The quantity is at least `lower` and at most `upper`, all rounding included.
struct Bounds {
    double lower = 0; ///< in the unit of the question: mm, mm^2 or mm^3
    double upper = 0; ///< infinite if no bound is known, or nothing is opaque
};

/// Why a search ended.
enum class StopReason : std::uint32_t {
    Closed,   ///< upper - lower is within the tolerance, or both are infinite
    Beyond,   ///< the distance is at least the maximum: `lower` is the maximum, `upper` is infinite
    Rounding, ///< rounding leaves the rest undecided
    Budget,   ///< the iteration limit was reached
};
/// Returns "closed", "beyond", "rounding" or "budget", with static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(StopReason reason) noexcept;

} // namespace voxtact
