// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/cells/vertex_reach.h"
#include "host/search/placed.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <optional>

namespace voxtact::cpu {

/// Where a mesh may be besides at its pose. A point that is at x may be
/// - turned about `centre` by no more than `turn`, or else within wide(x) of somewhere on the way from x - w to x + w
///   with w = linear * x + offset: what bends is of second order, and is in `wide`;
/// - and `slack` from there.
struct Sweep {
    double turn = 0; ///< radians, to pi; then nothing moves
    glm::dvec3 centre{};
    glm::dmat3 linear{0};
    glm::dvec3 offset{};
    glm::dvec3 straight{}; ///< of the offset: what is not of turning
    double bend = 0;       ///< of what turns on the way: what it is off its tangent, for each mm of its w
    double slack = 0;      ///< mm, of all points
    /// What vertices are off besides, each for itself, and points between them by no more than these; null: nothing.
    /// Where a mesh has placed something, that is in its `wide`.
    const VertexReach* each = nullptr;
    double eachScale = 0; ///< mm for one of its units

    /// The same, where x is measured from elsewhere.
    [[nodiscard]] Sweep from(const glm::dvec3& origin) const noexcept;

    /// How far along a normal a point may be, but for length(normal) * wide(x).
    [[nodiscard]] double reach(const glm::dvec3& normal, const glm::dvec3& x) const noexcept;
    [[nodiscard]] double wide(const glm::dvec3& x) const noexcept;
    /// The same of all points of a box.
    [[nodiscard]] double reach(const glm::dvec3& normal, const PlacedBox& box) const noexcept;
    [[nodiscard]] double wide(const PlacedBox& box) const noexcept;
    /// About the closest to `from` of the places where `x` may be.
    [[nodiscard]] glm::dvec3 near(const glm::dvec3& x, const glm::dvec3& from) const noexcept;
    /// The same of all points of something.
    [[nodiscard]] glm::dvec3 near(const PlacedBox& box, const glm::dvec3& from) const noexcept;
    [[nodiscard]] glm::dvec3 near(const PlacedTriangle& triangle, const glm::dvec3& from) const noexcept;
    /// The point of a triangle that gets there, where it is at its pose.
    [[nodiscard]] glm::dvec3 nearest(const PlacedTriangle& triangle, const glm::dvec3& from) const noexcept;

  private:
    [[nodiscard]] double turnedReach(const glm::dvec3& normal, const glm::dvec3& x) const noexcept;
    [[nodiscard]] glm::dvec3 nearTurned(const PlacedTriangle& triangle, const glm::dvec3& from) const noexcept;
    [[nodiscard]] glm::dvec3 nearShifted(const PlacedTriangle& triangle, const glm::dvec3& from) const noexcept;
    [[nodiscard]] std::optional<double> shiftTo(const PlacedTriangle& triangle, const glm::dvec3& from) const noexcept;
    [[nodiscard]] glm::dvec3 withSlack(const glm::dvec3& at, const glm::dvec3& from) const noexcept;
    /// How far on its way something gets the closest to `from`, from -1 to 1: `closest(part)` is its closest point
    /// there.
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
    /// One by the length; 0 where that is too short for its square to be right.
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
