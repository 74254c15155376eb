// SPDX-License-Identifier: MIT
#pragma once

#include "host/area/uv_polygon.h"
#include "host/search/mesh_place.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>

namespace voxtact::cpu {

/// mm^2: the parallelogram of two sides of a triangle.
[[nodiscard]] inline double parallelogramOf(const WorldTriangle& triangle) noexcept {
    return glm::length(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
}

/// A triangle in place, for its parts. Centred voxel coordinates (VolumeSpace).
struct AreaFrame {
    AreaFrame() = default;
    /// `error`: MeshPlace::error(), finite.
    AreaFrame(const VolumeSpace& space, const WorldTriangle& triangle, double error)
        : corner(space.toVoxel(triangle[0])), side1(space.toVoxel(triangle[1] - triangle[0])),
          side2(space.toVoxel(triangle[2] - triangle[0])) {
        const glm::dvec3 a = triangle[1] - triangle[0];
        const glm::dvec3 b = triangle[2] - triangle[0];
        const double area = parallelogramOf(triangle);
        const double doubt = 4 * error * (glm::length(a) + glm::length(b) + 4 * error);
        lo = std::max(area - doubt, 0.0);
        hi = area + doubt;
    }

    [[nodiscard]] glm::dvec3 at(const Uv& place) const noexcept { return corner + place.u * side1 + place.v * side2; }

    glm::dvec3 corner{};
    glm::dvec3 side1{};
    glm::dvec3 side2{};
    double lo = 0; ///< mm^2: the area of the parallelogram of both sides is no smaller
    double hi = 0; ///< and no larger
};

/// A box of centred voxel coordinates around a polygon.
struct AreaBox {
    AreaBox(const AreaFrame& frame, const UvPolygon& polygon) noexcept : lo(frame.at(polygon.corners[0])), hi(lo) {
        for (std::uint32_t i = 1; i < polygon.count; ++i) {
            const glm::dvec3 at = frame.at(polygon.corners[i]);
            lo = glm::min(lo, at);
            hi = glm::max(hi, at);
        }
    }

    glm::dvec3 lo;
    glm::dvec3 hi;
};

/// Range of heights of a polygon's corners above a plane through `at` perpendicular to an axis.
[[nodiscard]] inline Heights heightsAlong(const AreaFrame& frame, const UvPolygon& polygon, int axis,
                                          double at) noexcept {
    Heights heights{};
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        heights[i] = frame.at(polygon.corners[i])[axis] - at;
    }
    return heights;
}

/// Maximum error of computed coordinates.
struct AreaSlack {
    /// `error`: MeshPlace::error().
    AreaSlack(const VolumeSpace& space, double error) noexcept : place(2 * error / space.spacing) {}

    /// Voxel coordinates of a point.
    glm::dvec3 place;
    /// Maximum distance by which a part may extend out of its cell after a cut: many times the rounding of a
    /// coordinate.
    [[nodiscard]] double cut(int axis) const noexcept { return 2 * place[axis]; }
    /// Margin within which a cut may put a point on the wrong side of a plane: the errors of `cut` and `place`,
    /// doubled.
    [[nodiscard]] double doubt(int axis) const noexcept { return 2 * cut(axis); }
    /// The way along which a point's value may differ from the one that is computed, all axes together: from its true
    /// place to the computed one (`place`), from there into the cell (`cut`), the same way out again, by which the
    /// cell's interpolant is continued (`cut`), and as much as `place` for roundings.
    [[nodiscard]] double reach() const noexcept { return 6 * (place.x + place.y + place.z); }
};

} // namespace voxtact::cpu
