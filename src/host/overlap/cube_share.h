// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/cells/cell_piece.h"

#include <glm/vec3.hpp>

#include <optional>

/// Parts of the cube from -1 to 1 where a function is large enough: 0 to 1.
namespace voxtact::cpu {

/// A slope that is so much smaller than all together must be 0 for linearShare().
inline constexpr double kFlatSlope = 0x1p-16;
/// No such part is off by more: kFlatSlope is in the denominator.
inline constexpr double kShareError = 0x1p-30;

/// The part with dot(slope, s) >= `from`.
[[nodiscard]] double linearShare(const glm::dvec3& slope, double from) noexcept;

/// The part with a trilinear function >= `from`, behind a surface that crosses the whole cube.
struct GraphShare {
    double share = 0;
    double error = 0;     ///< it is not off by more
    double steepness = 0; ///< along the axis that the surface is behind, a unit changes the function by no less
    int axis = 0;         ///< across that one the cube is best divided
};
/// Empty if there is no axis along which the function is monotonic and crosses `from` on each line.
[[nodiscard]] std::optional<GraphShare> graphShare(const Trilinear& terms, double from) noexcept;

/// A linear function on the cube. Where it is farther than `off` from 0, it has the sign of a trilinear function minus
/// `from`.
struct LinearSign {
    glm::dvec3 slope{};
    double middle = 0;
    double off = 0;
    glm::dvec3 bent{}; ///< part of `off` that a division of the cube across each axis removes
};
[[nodiscard]] LinearSign linearSign(const Trilinear& terms, double from) noexcept;

} // namespace voxtact::cpu
