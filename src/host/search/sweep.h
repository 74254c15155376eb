// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/cells/vertex_reach.h"
#include "host/search/placed.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <optional>

namespace voxtact::cpu {

/// Positions of a mesh around its pose. A point at x may be - rotated about `centre` by at most `turn`, or within
/// wide(x) of a point between x - w and x + w, with w = linear * x + offset: deviations from the tangent are of second
/// order, and in `wide`; - and then within `slack`.
struct Sweep {
    double turn = 0; ///< radians, to pi; then nothing moves
    glm::dvec3 centre{};
    glm::dmat3 linear{0};
    glm::dvec3 offset{};
    glm::dvec3 straight{}; ///< translation part of the offset
    double bend = 0;       ///< maximum deviation of a rotating point from its tangent, per mm of its w
    double slack = 0;      ///< mm, of all points
    /// Additional displacement of each vertex; points between vertices have at most that of their vertices; null: none.
    /// Once a mesh has transformed an object, `wide` includes it.
    const VertexReach* each = nullptr;
    double eachScale = 0; ///< mm for one of its units

    /// Returns the sweep relative to another origin of x.
    [[nodiscard]] Sweep from(const glm::dvec3& origin) const noexcept;

    /// Returns the maximum of a point along a normal, without length(normal) * wide(x).
    [[nodiscard]] double reach(const glm::dvec3& normal, const glm::dvec3& x) const noexcept;
    [[nodiscard]] double wide(const glm::dvec3& x) const noexcept;
    /// Like reach(), over all points of a box.
    [[nodiscard]] double reach(const glm::dvec3& normal, const PlacedBox& box) const noexcept;
    [[nodiscard]] double wide(const PlacedBox& box) const noexcept;
    /// About the closest to `from` of the places where `x` may be.
    [[nodiscard]] glm::dvec3 near(const glm::dvec3& x, const glm::dvec3& from) const noexcept;
    /// Like near(), over all points of an object.
    [[nodiscard]] glm::dvec3 near(const PlacedBox& box, const glm::dvec3& from) const noexcept;
    [[nodiscard]] glm::dvec3 near(const PlacedTriangle& triangle, const glm::dvec3& from) const noexcept;
    /// Returns the nearest point of a triangle, at its pose.
    [[nodiscard]] glm::dvec3 nearest(const PlacedTriangle& triangle, const glm::dvec3& from) const noexcept;

  private:
    [[nodiscard]] double turnedReach(const glm::dvec3& normal, const glm::dvec3& x) const noexcept;
    [[nodiscard]] glm::dvec3 nearTurned(const PlacedTriangle& triangle, const glm::dvec3& from) const noexcept;
    [[nodiscard]] glm::dvec3 nearShifted(const PlacedTriangle& triangle, const glm::dvec3& from) const noexcept;
    [[nodiscard]] std::optional<double> shiftTo(const PlacedTriangle& triangle, const glm::dvec3& from) const noexcept;
    [[nodiscard]] glm::dvec3 withSlack(const glm::dvec3& at, const glm::dvec3& from) const noexcept;
    /// Returns the parameter from -1 to 1 at which an object comes nearest to `from`: `closest(part)` is its closest
    /// point there.
    template <class Closest>
    [[nodiscard]] glm::dvec3 onTheWay(const glm::dvec3& from, const Closest& closest) const noexcept;
};

/// A direction, and how far along it something of a mesh may be: the greatest dot product of a point with the normal.
class Direction {
  public:
    Direction() = default;
    /// `sweep` may be null, and must outlive it.
    Direction(const glm::dvec3& normal, const Sweep* sweep) noexcept
        : normal_(normal), length_(glm::length(normal)), sweep_(sweep) {}

    [[nodiscard]] const glm::dvec3& normal() const noexcept { return normal_; }
    [[nodiscard]] double length() const noexcept { return length_; }
    /// Returns one over the length; 0 if its square is inexact.
    [[nodiscard]] double inverse() const noexcept {
        constexpr double kShortest = 1e-140;
        return length_ > kShortest ? 1 / length_ : 0;
    }

    [[nodiscard]] double reach(const PlacedBox& box) const noexcept;
    [[nodiscard]] double reach(const PlacedTriangle& triangle) const noexcept;
    /// Expects some points.
    [[nodiscard]] double reach(const PointList& points) const noexcept;

  private:
    glm::dvec3 normal_{};
    double length_ = 0;
    const Sweep* sweep_ = nullptr;
};

} // namespace voxtact::cpu
