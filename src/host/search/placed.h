// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/clusters.h"
#include "host/search/closest_point.h"

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

    /// Returns approximately the closest point; exact if the sides are at right angles.
    [[nodiscard]] glm::dvec3 near(const glm::dvec3& from) const noexcept;
};

/// A triangle in place.
struct PlacedTriangle {
    WorldTriangle corners; ///< local
    glm::dvec3 lo{};       ///< centred voxel coordinates, of the box around all places where it may be
    glm::dvec3 hi{};
    double wide = 0; ///< mm, as PlacedBox has them
    double own = 0;

    /// Returns the closest point, up to rounding.
    [[nodiscard]] glm::dvec3 near(const glm::dvec3& from) const noexcept { return closestPoint(corners, from); }
};

/// Lanes of the longest vector. Rows are aligned for it, and multiples of it long.
inline constexpr std::size_t kMostDoubles = 8;
inline constexpr std::size_t kRowAlignment = kMostDoubles * sizeof(double);

/// The placed triangles of a cluster, row by row: the vector form of PlacedTriangle.
struct alignas(kRowAlignment) PlacedCluster {
    using Row = std::array<double, kClusterTriangles>;
    std::array<std::array<Row, 3>, 3> corners{}; ///< of each corner x, y and z
    std::array<Row, 3> lo{};
    std::array<Row, 3> hi{};
    /// For directions, which need not be exact: the inverse of the square of each side, from a to b, a to c and b to c,
    /// and of the sides' cross product; 0 for a degenerate triangle.
    std::array<Row, 4> inverses{};
    Row wide{}; ///< of a swept mesh alone
    Row own{};

    [[nodiscard]] PlacedTriangle triangle(std::size_t number) const noexcept {
        PlacedTriangle out;
        for (int axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<std::size_t>(axis);
            for (std::size_t corner = 0; corner < 3; ++corner) {
                out.corners[corner][axis] = corners[corner][at][number];
            }
            out.lo[axis] = lo[at][number];
            out.hi[axis] = hi[at][number];
        }
        out.wide = wide[number];
        out.own = own[number];
        return out;
    }
};

/// Some points of triangles.
struct alignas(kRowAlignment) PointList {
    static constexpr std::size_t kMost = 3 * std::size_t{kClusterTriangles};
    std::array<double, kMost> x{};
    std::array<double, kMost> y{};
    std::array<double, kMost> z{};
    std::size_t count = 0;
    double wide = 0; ///< mm, of a sweep: of the widest triangle
};

} // namespace voxtact::cpu
