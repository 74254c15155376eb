// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace voxtact::cpu {

/// A triangle of object space, and the welded numbers of its vertices.
struct SolidTriangle {
    std::array<glm::dvec3, 3> corners{};
    std::array<std::uint32_t, 3> vertices{};
};

/// Returns true if two triangles certainly share only their common vertices and edge.
[[nodiscard]] bool certainlyApart(const SolidTriangle& a, const SolidTriangle& b) noexcept;

/// Result of a ray against a triangle.
enum class Crossing : std::uint8_t { No, Leaves, Enters, Unknown };
/// The triangle's corners relative to the ray's origin, none of which is off by more than `off`. Leaves: along the
/// triangle's normal.
[[nodiscard]] Crossing crossingOf(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& direction,
                                  double off = 0) noexcept;

} // namespace voxtact::cpu
