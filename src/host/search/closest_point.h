// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <array>

namespace voxtact::cpu {

using WorldTriangle = std::array<glm::dvec3, 3>;

/// Relative to the product of two squared sides: a triangle with a smaller squared area is degenerate.
inline constexpr double kNoArea = 1e-20;

/// A point of the triangle, its corners' mean with weights from 0 to 1: the one closest to `from`, up to rounding.
[[nodiscard]] glm::dvec3 closestPoint(const WorldTriangle& triangle, const glm::dvec3& from) noexcept;

} // namespace voxtact::cpu
