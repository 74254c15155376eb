// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/clusters.h"
#include "cpu/clearance/closest_point.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>

namespace voxtact::cpu {

/// A box of a mesh's tree in place: a parallelepiped, and the box around all places where it may be.
struct PlacedBox {
    glm::dvec3 middle{};               ///< local (VolumeSpace)
    std::array<glm::dvec3, 3> sides{}; ///< half of each
    glm::dvec3 lo{};                   ///< centred voxel coordinates
    glm::dvec3 hi{};
    double diameter = 0; ///< mm
    double wide = 0;     ///< mm, of a sweep (Sweep::wide), and `own`
    double own = 0;      ///< mm, of its vertices by themselves (Sweep::each)

    /// A point of it that is about the closest one; it is where the sides are at right angles.
    [[nodiscard]] glm::dvec3 near(const glm::dvec3& from) const noexcept;
};

/// A triangle in place.
struct PlacedTriangle {
    WorldTriangle corners; ///< local
    glm::dvec3 lo{};       ///< centred voxel coordinates, of the box around all places where it may be
    glm::dvec3 hi{};
    double wide = 0; ///< mm, as PlacedBox has them
    double own = 0;

    /// The point of it that is closest, up to rounding.
    [[nodiscard]] glm::dvec3 near(const glm::dvec3& from) const noexcept { return closestPoint(corners, from); }
};

/// Some points of triangles.
struct PointList {
    static constexpr std::size_t kMost = 3 * std::size_t{kClusterTriangles};
    std::array<double, kMost> x{};
    std::array<double, kMost> y{};
    std::array<double, kMost> z{};
    std::size_t count = 0;
    double wide = 0; ///< mm, of a sweep: of the widest triangle
};

} // namespace voxtact::cpu
