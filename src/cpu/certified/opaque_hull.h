// SPDX-License-Identifier: MIT
#pragma once

#include "opacity_ranges.h"

#include <limits>

namespace voxtact::cpu {

/// From where to where a table is opaque, in entry coordinates: what takes some look-ups to ask of a range, for most
/// ranges takes two comparisons.
struct OpaqueHull {
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    /// No range that ends before `first` or begins after `last` may be opaque, nor any part of one (mayBeOpaque()).
    float first = kInfinity;
    float last = -kInfinity;
    /// Every range that does neither may be, or nearly so: there is no hole.
    bool whole = false;
    /// Every range within these certainly is opaque all over (certainlyAllOpaque()). Empty: no such range is known.
    float allFirst = kInfinity;
    float allLast = -kInfinity;
};

[[nodiscard]] OpaqueHull opaqueHullOf(const shader::OpacityTable& table) noexcept;

} // namespace voxtact::cpu
