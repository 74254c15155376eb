// SPDX-License-Identifier: MIT
#include "host/area/uv_polygon.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

/// Relative to the length of a polygon's edges: the rounding of coordinates up to 1 and of their products, and the
/// mismatch of neighbours, because each cuts a common edge on its own. A part is cut at most about 60 times before it
/// is too small.
constexpr double kEdgeError = 0x1p-47;

/// Returns the point at height 0 on an edge between corners on both sides.
Uv crossing(const Uv& a, double heightA, const Uv& b, double heightB) noexcept {
    const double part = heightA / (heightA - heightB);
    return {a.u + part * (b.u - a.u), a.v + part * (b.v - a.v)};
}

/// Sums up the area of a polygon that is given corner by corner.
class Corners {
  public:
    void add(const Uv& corner) noexcept {
        if (count_ == 0) {
            first_ = corner;
        } else {
            const Uv side{corner.u - first_.u, corner.v - first_.v};
            twice_ += last_.u * side.v - last_.v * side.u;
            last_ = side;
        }
        ++count_;
    }
    [[nodiscard]] double area() const noexcept { return std::max(twice_ / 2, 0.0); }

  private:
    Uv first_;
    Uv last_; ///< from the first
    double twice_ = 0;
    int count_ = 0;
};

/// Returns the area of the upper part.
double areaAbove(const UvPolygon& polygon, const Heights& heights, double from) noexcept {
    Corners part;
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        const std::uint32_t next = polygon.after(i);
        const double here = heights[i] - from;
        const double there = heights[next] - from;
        if (here >= 0) {
            part.add(polygon.corners[i]);
        }
        if ((here >= 0) != (there >= 0)) {
            part.add(crossing(polygon.corners[i], here, polygon.corners[next], there));
        }
    }
    return part.area();
}

/// -1 below the line, 1 above it, 0 on it.
using Sides = std::array<int, UvPolygon::kMost>;

/// Neighbours decide an uncertain corner if both are on one side: then the corners of each side are consecutive,
/// whatever the rounding.
Sides sidesOf(const UvPolygon& polygon, const Heights& heights, double slack) noexcept {
    Sides clear{};
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        clear[i] = heights[i] > slack ? 1 : (heights[i] < -slack ? -1 : 0);
    }
    Sides sides = clear;
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        std::uint32_t before = i;
        std::uint32_t after = i;
        for (std::uint32_t steps = 1; steps < polygon.count && clear[before] == 0; ++steps) {
            before = polygon.before(before);
        }
        for (std::uint32_t steps = 1; steps < polygon.count && clear[after] == 0; ++steps) {
            after = polygon.after(after);
        }
        if (clear[before] == clear[after]) {
            sides[i] = clear[before];
        }
    }
    return sides;
}

/// Counts a corner, too, that there is no room for.
void add(UvPolygon& part, const Uv& corner) noexcept {
    if (part.count < UvPolygon::kMost) {
        part.corners[part.count] = corner;
    }
    ++part.count;
}

} // namespace

double UvPolygon::area() const noexcept {
    Corners all;
    for (std::uint32_t i = 0; i < count; ++i) {
        all.add(corners[i]);
    }
    return all.area();
}

double UvPolygon::areaError() const noexcept {
    double length = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Uv& next = corners[after(i)];
        length += std::abs(next.u - corners[i].u) + std::abs(next.v - corners[i].v);
    }
    return kEdgeError * length;
}

bool split(const UvPolygon& polygon, const Heights& heights, double slack, UvPolygon& below,
           UvPolygon& above) noexcept {
    const Sides sides = sidesOf(polygon, heights, slack);
    below.count = 0;
    above.count = 0;
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        const std::uint32_t next = polygon.after(i);
        // The lower part keeps the last or the first of consecutive corners on the line.
        const bool ends = sides[i] == 0 && (sides[next] < 0 || sides[polygon.before(i)] < 0);
        if (sides[i] >= 0) {
            add(above, polygon.corners[i]);
        }
        if (sides[i] < 0 || ends) {
            add(below, polygon.corners[i]);
        }
        if (sides[i] * sides[next] < 0) {
            const Uv cut = crossing(polygon.corners[i], heights[i], polygon.corners[next], heights[next]);
            add(above, cut);
            add(below, cut);
        }
    }
    return below.count <= UvPolygon::kMost && above.count <= UvPolygon::kMost;
}

double areaBetween(const UvPolygon& polygon, const Heights& heights, double from, double to) noexcept {
    if (!(from < to)) {
        return 0;
    }
    const double above = std::isinf(from) ? polygon.area() : areaAbove(polygon, heights, from);
    return std::isinf(to) ? above : std::max(above - areaAbove(polygon, heights, to), 0.0);
}

} // namespace voxtact::cpu
