// SPDX-License-Identifier: MIT
#include "host/search/sweep.h"
#include "core/base/infinity.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::cross;
using glm::dot;
using glm::dvec3;

} // namespace

dvec3 PlacedBox::near(const dvec3& from) const noexcept {
    const dvec3 off = from - middle;
    dvec3 point = middle;
    for (const dvec3& side : sides) {
        const double square = dot(side, side);
        if (square > 0) {
            point += std::clamp(dot(off, side) / square, -1.0, 1.0) * side;
        }
    }
    return point;
}

Sweep Sweep::from(const dvec3& origin) const noexcept {
    Sweep out = *this;
    out.offset += linear * origin;
    out.centre -= origin;
    return out;
}

/// Rotated towards the normal as far as allowed, in their plane.
double Sweep::turnedReach(const dvec3& normal, const dvec3& x) const noexcept {
    const dvec3 arm = x - centre;
    const double along = dot(normal, arm);
    const double across = glm::length(cross(normal, arm));
    const bool gets = across * std::cos(turn) <= along * std::sin(turn);
    return dot(normal, centre) +
           (gets ? glm::length(normal) * glm::length(arm) : along * std::cos(turn) + across * std::sin(turn));
}

double Sweep::reach(const dvec3& normal, const dvec3& x) const noexcept {
    return turn > 0 ? turnedReach(normal, x) : dot(normal, x) + std::abs(dot(normal, linear * x + offset));
}

double Sweep::wide(const dvec3& x) const noexcept {
    return slack + bend * glm::length(linear * x + offset - straight);
}

double Sweep::reach(const dvec3& normal, const PlacedBox& box) const noexcept {
    if (turn > 0) {
        // Each rotation is linear, so the maximum is at a corner.
        double most = -kInfinity;
        for (unsigned i = 0; i < 8; ++i) {
            const dvec3 corner = box.middle + ((i & 1U) != 0 ? 1.0 : -1.0) * box.sides[0] +
                                 ((i & 2U) != 0 ? 1.0 : -1.0) * box.sides[1] +
                                 ((i & 4U) != 0 ? 1.0 : -1.0) * box.sides[2];
            most = std::max(most, turnedReach(normal, corner));
        }
        return most;
    }
    const dvec3 moved = normal * linear;
    const double way = dot(moved, box.middle) + dot(normal, offset);
    double ahead = way;
    double back = -way;
    for (const dvec3& side : box.sides) {
        ahead += std::abs(dot(normal + moved, side));
        back += std::abs(dot(normal - moved, side));
    }
    return dot(normal, box.middle) + std::max(ahead, back);
}

double Sweep::wide(const PlacedBox& box) const noexcept {
    double most = wide(box.middle);
    for (const dvec3& side : box.sides) {
        most += bend * glm::length(linear * side);
    }
    return most;
}

dvec3 Sweep::withSlack(const dvec3& at, const dvec3& from) const noexcept {
    const dvec3 off = from - at;
    const double size = glm::length(off);
    return size > slack ? at + slack / size * off : from;
}

/// Alternately: the closest point there, and how far on that one gets the closest.
template <class Closest> dvec3 Sweep::onTheWay(const dvec3& from, const Closest& closest) const noexcept {
    constexpr int kMostTurns = 6;
    constexpr double kWorthwhile = 1e-2;
    double part = 0;
    dvec3 at = closest(part);
    for (int i = 0; i < kMostTurns; ++i) {
        const dvec3 way = linear * at + offset;
        const double square = dot(way, way);
        if (!(square > 0)) {
            break;
        }
        const double next = std::clamp(part + dot(from - at, way) / square, -1.0, 1.0);
        const double gained = std::abs(next - part);
        part = next;
        at = closest(part);
        if (gained < kWorthwhile) {
            break;
        }
    }
    return at;
}

dvec3 Sweep::near(const dvec3& x, const dvec3& from) const noexcept {
    if (!(turn > 0)) {
        return withSlack(onTheWay(from, [&](double part) { return x + part * (linear * x + offset); }), from);
    }
    const dvec3 arm = x - centre;
    const dvec3 wanted = from - centre;
    const dvec3 axis = cross(arm, wanted);
    const double size = glm::length(axis);
    if (!(size > 0)) {
        return withSlack(x, from);
    }
    const double angle = std::min(std::atan2(size, dot(arm, wanted)), turn);
    return withSlack(centre + std::cos(angle) * arm + std::sin(angle) / size * cross(axis, arm), from);
}

dvec3 Sweep::near(const PlacedBox& box, const dvec3& from) const noexcept {
    if (turn > 0) {
        return near(box.near(from), from);
    }
    const dvec3 way = linear * box.middle + offset;
    return withSlack(onTheWay(from, [&](double part) { return box.near(from - part * way) + part * way; }), from);
}

/// After rotating a point to its closest position, another point may be closer; repeats with that one.
dvec3 Sweep::nearTurned(const PlacedTriangle& triangle, const dvec3& from) const noexcept {
    constexpr int kTurns = 2;
    dvec3 point = nearest(triangle, from);
    for (int i = 0; i < kTurns; ++i) {
        const dvec3 arm = point - centre;
        const dvec3 wanted = from - centre;
        const dvec3 axis = cross(arm, wanted);
        const double size = glm::length(axis);
        if (!(size > 0)) {
            break;
        }
        const double angle = std::min(std::atan2(size, dot(arm, wanted)), turn);
        const glm::dmat3 back = glm::mat3_cast(glm::angleAxis(-angle, axis / size));
        point = closestPoint(triangle.corners, centre + back * wanted);
    }
    return near(point, from);
}

/// Returns the intersection of a point's translation with a triangle, as a fraction of the translation; empty if there
/// is none.
std::optional<double> Sweep::shiftTo(const PlacedTriangle& triangle, const dvec3& from) const noexcept {
    const dvec3 ab = triangle.corners[1] - triangle.corners[0];
    const dvec3 ac = triangle.corners[2] - triangle.corners[0];
    const dvec3 normal = cross(ab, ac);
    const double slope = dot(normal, offset);
    const double part = dot(normal, from - triangle.corners[0]) / slope;
    if (!(std::abs(part) <= 1)) {
        return {};
    }
    const dvec3 at = from - part * offset - triangle.corners[0];
    const double area = dot(normal, normal);
    const double b = dot(normal, cross(at, ac)) / area;
    const double c = dot(normal, cross(ab, at)) / area;
    return b >= 0 && c >= 0 && b + c <= 1 ? std::optional(part) : std::nullopt;
}

/// The distance is a convex function of the part of the way (golden section: Kiefer, 1953).
dvec3 Sweep::nearShifted(const PlacedTriangle& triangle, const dvec3& from) const noexcept {
    constexpr int kSteps = 44; // to 10^-9 of the way
    constexpr double kGolden = 0.6180339887498949;
    const auto at = [&](double part) { return closestPoint(triangle.corners, from - part * offset) + part * offset; };
    if (const std::optional<double> part = shiftTo(triangle, from)) {
        return at(*part);
    }
    const auto far = [&](double part) {
        const dvec3 off = at(part) - from;
        return dot(off, off);
    };
    double begin = -1;
    double end = 1;
    double first = end - kGolden * (end - begin);
    double second = begin + kGolden * (end - begin);
    double atFirst = far(first);
    double atSecond = far(second);
    for (int i = 0; i < kSteps; ++i) {
        if (atFirst < atSecond) {
            end = second;
            second = first;
            atSecond = atFirst;
            first = end - kGolden * (end - begin);
            atFirst = far(first);
        } else {
            begin = first;
            first = second;
            atFirst = atSecond;
            second = begin + kGolden * (end - begin);
            atSecond = far(second);
        }
    }
    // The ends themselves are never tried in between.
    dvec3 best = at(0.5 * (begin + end));
    for (const double part : {-1.0, 1.0}) {
        const dvec3 other = at(part);
        best = glm::distance(other, from) < glm::distance(best, from) ? other : best;
    }
    return best;
}

dvec3 Sweep::near(const PlacedTriangle& triangle, const dvec3& from) const noexcept {
    if (turn > 0) {
        return nearTurned(triangle, from);
    }
    if (slack == 0 && linear == glm::dmat3(0)) {
        return nearShifted(triangle, from);
    }
    const auto closest = [&](double part) {
        WorldTriangle there = triangle.corners;
        for (dvec3& corner : there) {
            corner += part * (linear * corner + offset);
        }
        return closestPoint(there, from);
    };
    return withSlack(onTheWay(from, closest), from);
}

dvec3 Sweep::nearest(const PlacedTriangle& triangle, const dvec3& from) const noexcept {
    dvec3 best = triangle.near(from);
    if (turn > 0) {
        double least = glm::distance(near(best, from), from);
        for (const dvec3& corner : triangle.corners) {
            const double distance = glm::distance(near(corner, from), from);
            if (distance < least) {
                least = distance;
                best = corner;
            }
        }
    }
    return best;
}

double Direction::reach(const PlacedBox& box) const noexcept {
    if (sweep_ != nullptr) {
        return sweep_->reach(normal_, box) + length_ * box.wide;
    }
    return dot(normal_, box.middle) + (std::abs(dot(normal_, box.sides[0])) + std::abs(dot(normal_, box.sides[1])) +
                                       std::abs(dot(normal_, box.sides[2])));
}

double Direction::reach(const PlacedTriangle& triangle) const noexcept {
    const auto& [a, b, c] = triangle.corners;
    if (sweep_ == nullptr) {
        return std::max({dot(normal_, a), dot(normal_, b), dot(normal_, c)});
    }
    return std::max({sweep_->reach(normal_, a), sweep_->reach(normal_, b), sweep_->reach(normal_, c)}) +
           length_ * triangle.wide;
}

double Direction::reach(const PointList& points) const noexcept {
    // Two at a time, for the processor.
    double even = -kInfinity;
    double odd = even;
    std::size_t i = 0;
    if (sweep_ != nullptr) {
        for (; i < points.count; ++i) {
            even = std::max(even, sweep_->reach(normal_, dvec3(points.x[i], points.y[i], points.z[i])));
        }
        return even + length_ * points.wide;
    }
    const auto at = [&](std::size_t k) {
        return normal_.x * points.x[k] + normal_.y * points.y[k] + normal_.z * points.z[k];
    };
    for (; i + 1 < points.count; i += 2) {
        even = std::max(even, at(i));
        odd = std::max(odd, at(i + 1));
    }
    if (i < points.count) {
        even = std::max(even, at(i));
    }
    return std::max(even, odd);
}

} // namespace voxtact::cpu
