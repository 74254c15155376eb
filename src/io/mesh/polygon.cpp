// SPDX-License-Identifier: MIT
#include "io/mesh/polygon.h"
#include "core/geometry/vec3.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace voxtact::io {

namespace {

using Point = std::array<double, 2>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Twice the area of a, b, c; positive where they turn left.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double largest(const Vec3& v) {
    return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

/// The corners as seen from the first, scaled by a power of two to about 1, which changes no digit; none where the
/// polygon is larger than a double.
std::optional<std::vector<Vec3>> centred(std::span<const Vec3> corners) {
    std::vector<Vec3> points(corners.begin(), corners.end());
    double extent = 0;
    for (Vec3& point : points) {
        for (std::size_t i = 0; i < 3; ++i) {
            point[i] -= corners[0][i];
        }
        extent = std::max(extent, largest(point));
    }
    if (!std::isfinite(extent)) {
        return std::nullopt;
    }
    const int exponent = extent > 0 ? -std::ilogb(extent) : 0;
    for (Vec3& point : points) {
        for (double& coordinate : point) {
            coordinate = std::ldexp(coordinate, exponent);
        }
    }
    return points;
}

/// True where all points lie on one line.
bool areOnALine(const std::vector<Vec3>& points) {
    constexpr double kTolerance = 1e-12;
    const Vec3 far = *std::max_element(points.begin(), points.end(),
                                       [](const Vec3& a, const Vec3& b) { return largest(a) < largest(b); });
    return std::all_of(points.begin(), points.end(),
                       [&](const Vec3& point) { return largest(cross(far, point)) <= kTolerance; });
}

/// Returns the largest projection of the polygon along an axis, counter-clockwise; empty if all have no area.
std::vector<Point> shadow(const std::vector<Vec3>& points) {
    constexpr double kTolerance = 1e-12;
    Vec3 normal{};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 part = cross(points[i], points[(i + 1) % points.size()]);
        for (std::size_t k = 0; k < 3; ++k) {
            normal[k] += part[k];
        }
    }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k) {
        axis = std::abs(normal[k]) > std::abs(normal[axis]) ? k : axis;
    }
    if (std::abs(normal[axis]) <= kTolerance) {
        return {};
    }
    std::size_t x = (axis + 1) % 3;
    std::size_t y = (axis + 2) % 3;
    if (normal[axis] < 0) {
        std::swap(x, y);
    }
    std::vector<Point> flat;
    flat.reserve(points.size());
    for (const Vec3& point : points) {
        flat.push_back({point[x], point[y]});
    }
    return flat;
}

/// Seen from the first corner, the others come in order from right to left within half a turn: then the triangles
/// around it do not overlap and are the polygon.
bool isFan(const std::vector<Point>& flat) {
    for (std::size_t i = 1; i + 1 < flat.size(); ++i) {
        if (turn(flat[0], flat[i], flat[i + 1]) < 0 || turn(flat[0], flat[1], flat[i + 1]) < 0) {
            return false;
        }
    }
    return true;
}

bool crossesItself(const std::vector<Point>& flat) {
    const std::size_t n = flat.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Point& a = flat[i];
        const Point& b = flat[(i + 1) % n];
        for (std::size_t j = i + 2; j < n; ++j) {
            const Point& c = flat[j];
            const Point& d = flat[(j + 1) % n];
            const double abc = turn(a, b, c);
            const double abd = turn(a, b, d);
            if (!((abc > 0 && abd < 0) || (abc < 0 && abd > 0))) {
                continue;
            }
            const double cda = turn(c, d, a);
            const double cdb = turn(c, d, b);
            if ((cda > 0 && cdb < 0) || (cda < 0 && cdb > 0)) {
                return true;
            }
        }
    }
    return false;
}

/// Cuts ears off a polygon that does not cross itself. A cut can create new ears only at its two neighbours: the rest
/// is a part of the polygon, and an outside diagonal stays outside.
class EarCutter {
  public:
    EarCutter(const std::vector<Point>& flat, Triangles& triangles)
        : flat_(flat), triangles_(triangles), before_(flat.size()), after_(flat.size()), gone_(flat.size(), 0),
          left_(flat.size()) {
        const auto n = static_cast<std::uint32_t>(flat.size());
        for (std::uint32_t i = 0; i < n; ++i) {
            before_[i] = (i + n - 1) % n;
            after_[i] = (i + 1) % n;
        }
    }

    bool cut() {
        // Bridges to holes touch other edges; the second round permits this.
        return cutRound(false) || cutRound(true);
    }

  private:
    bool cutRound(bool mayTouch) {
        std::deque<std::uint32_t> candidates;
        for (std::uint32_t i = 0; i < flat_.size(); ++i) {
            if (gone_[i] == 0) {
                candidates.push_back(i);
            }
        }
        while (left_ > 3 && !candidates.empty()) {
            const std::uint32_t tip = candidates.front();
            candidates.pop_front();
            if (gone_[tip] != 0 || !isEar(tip, mayTouch)) {
                continue;
            }
            triangles_.push_back({before_[tip], tip, after_[tip]});
            after_[before_[tip]] = after_[tip];
            before_[after_[tip]] = before_[tip];
            gone_[tip] = 1;
            --left_;
            candidates.push_back(before_[tip]);
            candidates.push_back(after_[tip]);
        }
        if (left_ > 3) {
            return false;
        }
        const auto tip = static_cast<std::uint32_t>(std::find(gone_.begin(), gone_.end(), 0) - gone_.begin());
        triangles_.push_back({before_[tip], tip, after_[tip]});
        return turnAt(tip) >= 0;
    }

    [[nodiscard]] double turnAt(std::uint32_t corner) const {
        return turn(flat_[before_[corner]], flat_[corner], flat_[after_[corner]]);
    }

    [[nodiscard]] bool isEar(std::uint32_t tip, bool mayTouch) const {
        const Point& a = flat_[before_[tip]];
        const Point& b = flat_[tip];
        const Point& c = flat_[after_[tip]];
        const double area = turn(a, b, c);
        if (area <= 0) {
            return area == 0;
        }
        for (std::uint32_t i = after_[after_[tip]]; i != before_[tip]; i = after_[i]) {
            const Point& p = flat_[i];
            if (p == a || p == b || p == c || turnAt(i) > 0) {
                continue;
            }
            const double least = std::min({turn(a, b, p), turn(b, c, p), turn(c, a, p)});
            if (least > 0 || (least == 0 && !mayTouch)) {
                return false;
            }
        }
        return true;
    }

    const std::vector<Point>& flat_;
    Triangles& triangles_;
    std::vector<std::uint32_t> before_;
    std::vector<std::uint32_t> after_;
    std::vector<std::uint8_t> gone_;
    std::size_t left_;
};

} // namespace

std::optional<std::string> cutPolygon(std::span<const Vec3> corners, Triangles& triangles) {
    triangles.clear();
    const std::optional<std::vector<Vec3>> points = centred(corners);
    if (!points) {
        return "a polygon is larger than a double holds";
    }
    const std::vector<Point> flat = shadow(*points);
    if (flat.empty() ? areOnALine(*points) : isFan(flat)) {
        for (std::uint32_t i = 1; i + 1 < corners.size(); ++i) {
            triangles.push_back({0, i, i + 1});
        }
        return std::nullopt;
    }
    // The following step takes quadratic time.
    constexpr std::size_t kMostCorners = 4096;
    if (corners.size() > kMostCorners) {
        return "a polygon of " + std::to_string(corners.size()) +
               " corners is too large to be cut; triangulate the file";
    }
    if (flat.empty() || crossesItself(flat) || !EarCutter(flat, triangles).cut()) {
        return "a polygon cannot be cut into triangles (it crosses itself?); triangulate the file";
    }
    return std::nullopt;
}

} // namespace voxtact::io
