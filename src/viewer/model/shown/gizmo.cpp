// SPDX-License-Identifier: MIT
#include "viewer/model/shown/gizmo.h"
#include "core/geometry/vec3.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace voxtact::view {

namespace {

constexpr double kFlat = 0.1; // sine of the angle between a plane and the ray
constexpr double kDegree = std::numbers::pi / 180;

double snapped(double value, double step) {
    return step > 0 ? std::round(value / step) * step : value;
}

/// Returns the distance along the axis, from the gizmo, of the point nearest to the ray; empty if nearly parallel.
std::optional<double> alongAxis(const Gizmo& gizmo, std::size_t axis, const Ray& ray) {
    const Vec3& line = gizmo.axes[axis];
    const double cosine = dot(line, ray.direction);
    const double sine2 = 1 - cosine * cosine;
    if (!(sine2 > kFlat * kFlat)) {
        return std::nullopt;
    }
    const Vec3 between = step(ray.origin, gizmo.at, -1);
    return (dot(between, line) - cosine * dot(between, ray.direction)) / sine2;
}

/// Returns the intersection of the ray and the plane across an axis, relative to the gizmo; empty if edge-on.
std::optional<Vec3> inPlane(const Gizmo& gizmo, std::size_t axis, const Ray& ray) {
    if (edgeOn(gizmo, axis, ray.direction)) {
        return std::nullopt;
    }
    const Vec3 between = step(ray.origin, gizmo.at, -1);
    const double far = -dot(between, gizmo.axes[axis]) / dot(ray.direction, gizmo.axes[axis]);
    return step(between, ray.direction, far);
}

double distanceOf(const Ray& ray, const Vec3& point) {
    return length(cross(step(point, ray.origin, -1), ray.direction));
}

bool inSquare(const Gizmo& gizmo, std::size_t axis, const Vec3& place) {
    return std::ranges::all_of(std::array{(axis + 1) % 3, (axis + 2) % 3}, [&](std::size_t side) {
        const double part = dot(place, gizmo.axes[side]) / gizmo.size;
        return part >= kSquareBegin && part <= kSquareEnd;
    });
}

Vec3 shiftOf(const Gizmo& gizmo, const Handle& handle, const Ray& from, const Ray& to, double interval) {
    Vec3 shift{};
    if (handle.kind == HandleKind::Arrow) {
        const auto before = alongAxis(gizmo, handle.axis, from);
        const auto after = alongAxis(gizmo, handle.axis, to);
        return before && after ? step({}, gizmo.axes[handle.axis], snapped(*after - *before, interval)) : shift;
    }
    const auto before = inPlane(gizmo, handle.axis, from);
    const auto after = inPlane(gizmo, handle.axis, to);
    for (std::size_t side = 0; before && after && side < 3; ++side) {
        if (side != handle.axis) {
            const double far = dot(step(*after, *before, -1), gizmo.axes[side]);
            shift = step(shift, gizmo.axes[side], snapped(far, interval));
        }
    }
    return shift;
}

/// Degrees about the handle's axis.
double turnOf(const Gizmo& gizmo, const Handle& handle, const Ray& from, const Ray& to) {
    const auto before = inPlane(gizmo, handle.axis, from);
    const auto after = inPlane(gizmo, handle.axis, to);
    if (!before || !after) {
        return 0;
    }
    return std::atan2(dot(cross(*before, *after), gizmo.axes[handle.axis]), dot(*before, *after)) / kDegree;
}

} // namespace

Ray rayThrough(const Camera& camera, const Extent& extent, double x, double y) noexcept {
    const Mat4 eye = eyeFromWorld(camera.direction);
    const double mm = millimetresOfPixel(camera, extent);
    Vec3 origin = step(camera.target, {eye[0], eye[4], eye[8]}, (x - extent.width / 2.0) * mm);
    origin = step(origin, {eye[1], eye[5], eye[9]}, (y - extent.height / 2.0) * mm);
    return {origin, {eye[2], eye[6], eye[10]}};
}

Gizmo gizmoOf(const Mat4& world_from_object, const Camera& camera, GizmoAxes axes, double size) noexcept {
    Gizmo gizmo{originOf(world_from_object), {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, size};
    if (axes == GizmoAxes::View) {
        const Mat4 eye = eyeFromWorld(camera.direction);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            gizmo.axes[axis] = {eye[axis], eye[4 + axis], eye[8 + axis]};
        }
    } else if (axes == GizmoAxes::Own) {
        const Vec3 x = axisOf(world_from_object, 0);
        const Vec3 across = cross(x, axisOf(world_from_object, 1));
        if (length(across) > kFlat) { // a pose without a volume has no axes of its own
            const Vec3 z = unit(across);
            gizmo.axes = {x, cross(z, x), z};
        }
    }
    return gizmo;
}

bool edgeOn(const Gizmo& gizmo, std::size_t axis, const Vec3& direction) noexcept {
    return !(std::abs(dot(gizmo.axes[axis], direction)) > kFlat);
}

Handle handleAt(const Gizmo& gizmo, const Ray& ray, double reach) noexcept {
    Handle best;
    double nearest = reach;
    const auto offer = [&](HandleKind kind, std::size_t axis, double distance) {
        if (distance <= nearest) {
            nearest = distance;
            best = {kind, axis};
        }
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (const auto place = inPlane(gizmo, axis, ray); place && length(*place) > 0) {
            const Vec3 onRing = step(gizmo.at, unit(*place), kRingRadius * gizmo.size);
            offer(HandleKind::Ring, axis, distanceOf(ray, onRing));
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (const auto along = alongAxis(gizmo, axis, ray)) {
            const double part = std::clamp(*along, kArrowBegin * gizmo.size, gizmo.size);
            offer(HandleKind::Arrow, axis, distanceOf(ray, step(gizmo.at, gizmo.axes[axis], part)));
        }
    }
    for (std::size_t axis = 0; best.kind == HandleKind::None && axis < 3; ++axis) {
        const auto place = inPlane(gizmo, axis, ray);
        if (place && inSquare(gizmo, axis, *place)) {
            best = {HandleKind::Square, axis};
        }
    }
    return best;
}

Mat4 dragged(const Mat4& world_from_object, const Gizmo& gizmo, const Handle& handle, const Ray& from, const Ray& to,
             const Snap& snap) noexcept {
    switch (handle.kind) {
    case HandleKind::Arrow:
    case HandleKind::Square:
        return placedAt(world_from_object,
                        step(originOf(world_from_object), shiftOf(gizmo, handle, from, to, snap.millimetres), 1));
    case HandleKind::Ring:
        return turnedAbout(world_from_object, gizmo.axes[handle.axis],
                           snapped(turnOf(gizmo, handle, from, to), snap.degrees));
    case HandleKind::None:
        break;
    }
    return world_from_object;
}

} // namespace voxtact::view
