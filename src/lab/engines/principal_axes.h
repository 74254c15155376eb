// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <array>
#include <cstdint>
#include <span>

namespace voxtact {

[[nodiscard]] inline Vec3 vertexOf(const MeshView& mesh, std::uint32_t triangle, std::size_t corner) noexcept {
    const float* at = mesh.positions.data() + std::size_t{3} * mesh.indices[std::size_t{3} * triangle + corner];
    return {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
}

/// Three unit vectors, at right angles but for rounding: the directions in which some triangles of a mesh spread, each
/// triangle with the weight of its area; triangles without any area count alike. Gottschalk, Lin, Manocha, "OBBTree",
/// SIGGRAPH 1996, section 4, but of the surface itself and not of its convex hull. At least one triangle.
[[nodiscard]] std::array<Vec3, 3> principalAxes(const MeshView& mesh,
                                                std::span<const std::uint32_t> triangles) noexcept;

} // namespace voxtact
