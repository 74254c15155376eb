// SPDX-License-Identifier: MIT
#include "oracle/certified_cut.h"

#include <algorithm>
#include <cmath>

namespace voxtact::oracle::certified {

namespace {

enum class Side { Above, Below };

/// The part on one side of a plane, which belongs to it. Sutherland and Hodgman, "Reentrant polygon clipping", 1974.
Polygon cut(const Polygon& polygon, std::size_t axis, double at, Side side) {
    const auto inside = [&](const Vec3& point) { return side == Side::Above ? point[axis] >= at : point[axis] <= at; };
    Polygon out;
    out.reserve(polygon.size() + 1);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3& a = polygon[i];
        const Vec3& b = polygon[(i + 1) % polygon.size()];
        if (inside(a)) {
            out.push_back(a);
        }
        if (inside(a) != inside(b)) {
            const double weight = (at - a[axis]) / (b[axis] - a[axis]);
            Vec3 between{};
            for (std::size_t c = 0; c < 3; ++c) {
                between[c] = a[c] + weight * (b[c] - a[c]);
            }
            between[axis] = at;
            out.push_back(between);
        }
    }
    return out;
}

double length(const Vec3& a, const Vec3& b) {
    return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

} // namespace

Region shrunk(Region region, double by) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        region.lo[axis] += by;
        region.hi[axis] -= by;
    }
    return region;
}

Region boundsOf(std::span<const Vec3> points) {
    Region out{points.front(), points.front()};
    for (const Vec3& point : points) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out.lo[axis] = std::min(out.lo[axis], point[axis]);
            out.hi[axis] = std::max(out.hi[axis], point[axis]);
        }
    }
    return out;
}

bool meet(const Region& a, const Region& b) {
    bool out = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out = out && std::max(a.lo[axis], b.lo[axis]) <= std::min(a.hi[axis], b.hi[axis]);
    }
    return out;
}

Polygon slab(const Polygon& polygon, std::size_t axis, double lo, double hi) {
    return cut(cut(polygon, axis, lo, Side::Above), axis, hi, Side::Below);
}

Vec3 centroid(const Corners& triangle) {
    const auto& [a, b, c] = triangle;
    return {(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3, (a[2] + b[2] + c[2]) / 3};
}

double longestEdge(const Corners& triangle) {
    const auto& [a, b, c] = triangle;
    return std::max({length(a, b), length(b, c), length(c, a)});
}

Vec3 middle(const Vec3& a, const Vec3& b) {
    return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
}

std::array<Corners, 2> halves(const Corners& triangle) {
    std::size_t longest = 0;
    double most = -1;
    for (std::size_t edge = 0; edge < 3; ++edge) {
        const double here = length(triangle[edge], triangle[(edge + 1) % 3]);
        if (here > most) {
            most = here;
            longest = edge;
        }
    }
    const Vec3& a = triangle[longest];
    const Vec3& b = triangle[(longest + 1) % 3];
    const Vec3& c = triangle[(longest + 2) % 3];
    return {Corners{a, middle(a, b), c}, Corners{middle(a, b), b, c}};
}

} // namespace voxtact::oracle::certified
