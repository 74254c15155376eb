// SPDX-License-Identifier: MIT
#include "host/search/closest_point.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace voxtact::cpu {

namespace {

using glm::cross;
using glm::dot;
using glm::dvec3;

double share(double part, double whole) {
    return std::clamp(part / whole, 0.0, 1.0);
}

dvec3 onSegment(const dvec3& a, const dvec3& b, const dvec3& from) {
    const dvec3 ab = b - a;
    const double square = dot(ab, ab);
    return square > 0 ? a + share(dot(from - a, ab), square) * ab : a;
}

/// For a degenerate triangle.
dvec3 onEdges(const WorldTriangle& triangle, const dvec3& from) {
    dvec3 best = triangle[0];
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 point = onSegment(triangle[i], triangle[(i + 1) % 3], from);
        if (glm::distance(point, from) < glm::distance(best, from)) {
            best = point;
        }
    }
    return best;
}

} // namespace

/// By the region of the plane above which the point lies (Ericson, "Real-Time Collision Detection", 2005, section
/// 5.1.5).
dvec3 closestPoint(const WorldTriangle& triangle, const dvec3& from) noexcept {
    const auto& [a, b, c] = triangle;
    const dvec3 ab = b - a;
    const dvec3 ac = c - a;
    const dvec3 ap = from - a;
    const dvec3 normal = cross(ab, ac);
    if (!(dot(normal, normal) > kNoArea * dot(ab, ab) * dot(ac, ac))) {
        return onEdges(triangle, from);
    }
    const double d1 = dot(ab, ap);
    const double d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) {
        return a;
    }
    const dvec3 bp = from - b;
    const double d3 = dot(ab, bp);
    const double d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) {
        return b;
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        return a + share(d1, d1 - d3) * ab;
    }
    const dvec3 cp = from - c;
    const double d5 = dot(ab, cp);
    const double d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) {
        return c;
    }
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        return a + share(d2, d2 - d6) * ac;
    }
    const double va = d3 * d6 - d5 * d4;
    const double toC = d4 - d3;
    const double toB = d5 - d6;
    if (va <= 0 && toC >= 0 && toB >= 0) {
        return b + share(toC, toC + toB) * (c - b);
    }
    const double all = va + vb + vc;
    if (!(all > 0)) {
        return onEdges(triangle, from);
    }
    const double v = share(vb, all);
    return a + v * ab + std::min(share(vc, all), 1 - v) * ac;
}

} // namespace voxtact::cpu
