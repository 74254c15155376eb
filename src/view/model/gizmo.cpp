// SPDX-License-Identifier: MIT
#include "view/model/gizmo.h"

#include "view/model/pose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace voxtact::view {

namespace {

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// a + s b
Vec3 along(const Vec3& a, double s, const Vec3& b) {
    return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

/// Across the ray: without what is along it.
Vec3 seen(const Ray& ray, const Vec3& vector) {
    return along(vector, -dot(vector, ray.direction), ray.direction);
}

/// As the ray sees it: from a segment to the ray.
double distance(const Ray& ray, const Vec3& from, const Vec3& to) {
    const Vec3 a = seen(ray, along(from, -1, ray.origin));
    const Vec3 way = seen(ray, along(to, -1, from));
    const double square = dot(way, way);
    const double share = square > 0 ? std::clamp(-dot(a, way) / square, 0.0, 1.0) : 0;
    const Vec3 nearest = along(a, share, way);
    return std::sqrt(dot(nearest, nearest));
}

/// Two unit vectors at right angles to an axis and to each other, right-handed with it.
std::array<Vec3, 2> planeOf(const Vec3& axis) {
    const std::size_t least = static_cast<std::size_t>(
        std::ranges::min_element(axis, {}, [](double x) { return std::abs(x); }) - axis.begin());
    Vec3 other{};
    other[least] = 1;
    Vec3 u = cross(axis, other);
    const double length = std::sqrt(dot(u, u));
    u = {u[0] / length, u[1] / length, u[2] / length};
    return {u, cross(axis, u)};
}

/// mm along an axis through the centre, of its point nearest to a ray that is not parallel to it.
double alongAxis(const Gizmo& gizmo, const Vec3& axis, const Ray& ray) {
    const Vec3 across = seen(ray, axis);
    return dot(seen(ray, along(ray.origin, -1, gizmo.centre)), across) / dot(across, across);
}

/// Radians about an axis, of where a ray meets its plane, which it is not parallel to.
double aboutAxis(const Gizmo& gizmo, const Vec3& axis, const Ray& ray) {
    const Vec3 to = along(gizmo.centre, -1, ray.origin);
    const Vec3 met = along(ray.origin, dot(to, axis) / dot(ray.direction, axis), ray.direction);
    const auto [u, v] = planeOf(axis);
    const Vec3 arm = along(met, -1, gizmo.centre);
    return std::atan2(dot(arm, v), dot(arm, u));
}

} // namespace

Gizmo gizmoOf(const Mat4& world_from_object, bool ownAxes, double pixel) noexcept {
    Gizmo gizmo;
    gizmo.centre = originOf(world_from_object);
    gizmo.size = kGizmoPixels * pixel;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        gizmo.axes[axis] = axisOf(ownAxes ? world_from_object : identity(), axis);
    }
    return gizmo;
}

Ray rayThrough(const Camera& camera, const Extent& extent, const Point2& pixel) noexcept {
    const Mat4 eye = eyeFromWorld(camera.direction);
    const double mm = millimetresOfPixel(camera, extent);
    const double right = (pixel[0] - extent.width / 2.0) * mm;
    const double down = (pixel[1] - extent.height / 2.0) * mm;
    const Vec3 target = along(camera.target, right, {eye[0], eye[4], eye[8]});
    return {along(target, down, {eye[1], eye[5], eye[9]}), {eye[2], eye[6], eye[10]}};
}

std::vector<Vec3> ringOf(const Gizmo& gizmo, std::size_t axis) {
    const auto [u, v] = planeOf(gizmo.axes[axis]);
    std::vector<Vec3> corners;
    for (std::size_t piece = 0; piece < kRingPieces; ++piece) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(piece) / kRingPieces;
        corners.push_back(along(along(gizmo.centre, gizmo.size * std::cos(angle), u), gizmo.size * std::sin(angle), v));
    }
    return corners;
}

Vec3 tipOf(const Gizmo& gizmo, std::size_t axis) noexcept {
    return along(gizmo.centre, gizmo.size, gizmo.axes[axis]);
}

bool isUsable(const Gizmo& gizmo, const GizmoPart& part, const Ray& ray) noexcept {
    constexpr double kLeast = 0.15; // about 9 degrees
    const double into = std::abs(dot(gizmo.axes[part.axis], ray.direction));
    return part.handle == Handle::Arrow ? std::sqrt(std::max(1 - into * into, 0.0)) >= kLeast : into >= kLeast;
}

std::optional<GizmoPart> partUnder(const Gizmo& gizmo, const Ray& ray, double reach) {
    std::optional<GizmoPart> best;
    const auto offer = [&](const GizmoPart& part, double away) {
        if (away < reach && isUsable(gizmo, part, ray)) {
            best = part;
            reach = away;
        }
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // All arrows begin in the middle, where none is meant.
        constexpr double kFrom = 0.25;
        const Vec3 from = along(gizmo.centre, kFrom * gizmo.size, gizmo.axes[axis]);
        offer({Handle::Arrow, axis}, distance(ray, from, tipOf(gizmo, axis)));
        const std::vector<Vec3> ring = ringOf(gizmo, axis);
        double away = std::numeric_limits<double>::infinity();
        for (std::size_t piece = 0; piece < ring.size(); ++piece) {
            away = std::min(away, distance(ray, ring[piece], ring[(piece + 1) % ring.size()]));
        }
        offer({Handle::Ring, axis}, away);
    }
    return best;
}

Mat4 dragged(const GizmoDrag& drag, const Ray& to) {
    const Vec3& axis = drag.gizmo.axes[drag.part.axis];
    if (drag.part.handle == Handle::Arrow) {
        const double mm = alongAxis(drag.gizmo, axis, to) - alongAxis(drag.gizmo, axis, drag.from);
        return placedAt(drag.pose, along(originOf(drag.pose), mm, axis));
    }
    const double radians = aboutAxis(drag.gizmo, axis, to) - aboutAxis(drag.gizmo, axis, drag.from);
    return turnedAbout(drag.pose, axis, radians * 180 / std::numbers::pi);
}

} // namespace voxtact::view
