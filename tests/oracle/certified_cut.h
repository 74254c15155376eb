// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <array>
#include <span>
#include <vector>

/// Triangles cut at axis-aligned planes and into pieces, for the certified oracle. Index space.
namespace voxtact::oracle::certified {

using Corners = std::array<Vec3, 3>;
/// Convex, its corners in order; a segment and a point are polygons too.
using Polygon = std::vector<Vec3>;

/// An axis-aligned box; empty where lo is above hi.
struct Region {
    Vec3 lo{};
    Vec3 hi{};
};

/// By so much on all sides.
[[nodiscard]] Region shrunk(Region region, double by);
/// Of at least one point.
[[nodiscard]] Region boundsOf(std::span<const Vec3> points);
/// Whether two boxes have a point in common.
[[nodiscard]] bool meet(const Region& a, const Region& b);

/// The part of a polygon between two planes across an axis, which belong to it. Corners that it makes are off by some
/// roundings of the largest coordinate.
[[nodiscard]] Polygon slab(const Polygon& polygon, std::size_t axis, double lo, double hi);

[[nodiscard]] Vec3 centroid(const Corners& triangle);
[[nodiscard]] double longestEdge(const Corners& triangle);
[[nodiscard]] Vec3 middle(const Vec3& a, const Vec3& b);
/// In the middle of the longest edge.
[[nodiscard]] std::array<Corners, 2> halves(const Corners& triangle);

} // namespace voxtact::oracle::certified
