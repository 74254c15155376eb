// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/clearance.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

/// How near the pair is, as the host measures it beside the answer.
namespace voxtact::view {

struct LiveClearance {
    std::uint64_t revision = 0; ///< of the question
    PairClearance pair;
    double milliseconds = 0; ///< wall clock
};

/// "12.34 to 12.35 mm away", "touches", "nothing is opaque".
[[nodiscard]] std::string clearanceText(const PairClearance& clearance);

/// The two closest points, on the mesh and in what is opaque; nothing where it touches, or nothing is opaque.
[[nodiscard]] std::optional<std::array<Vec3, 2>> closestSegment(const PairClearance& clearance) noexcept;

/// mm from a plane at right angles to an axis of the world to the nearer end of a segment; 0 where it goes through.
[[nodiscard]] double distanceOfPlane(const std::array<Vec3, 2>& segment, std::size_t axis, double at) noexcept;

} // namespace voxtact::view
