// SPDX-License-Identifier: MIT
#include "viewer/model/document/pose.h"

#include "core/geometry/vec3.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxtact::view {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// About a unit axis through the world's origin (Rodrigues).
Mat4 rotation(const Vec3& axis, double degrees) {
    const double c = std::cos(degrees * kDegree);
    const double s = std::sin(degrees * kDegree);
    const auto& [x, y, z] = axis;
    const double t = 1 - c;
    return {t * x * x + c,
            t * x * y + s * z,
            t * x * z - s * y,
            0, //
            t * x * y - s * z,
            t * y * y + c,
            t * y * z + s * x,
            0, //
            t * x * z + s * y,
            t * y * z - s * x,
            t * z * z + c,
            0, //
            0,
            0,
            0,
            1};
}

/// Returns a unit vector perpendicular to two; if both are parallel, to the first and a world axis.
Vec3 upright(const Vec3& x, const Vec3& y) {
    constexpr double kSame = 1e-9;
    const bool along = std::abs(x[1]) > 0.9;
    const Vec3 out = cross(x, y);
    return unit(length(out) < kSame ? cross(x, along ? Vec3{-1, 0, 0} : Vec3{0, 1, 0}) : out);
}

} // namespace

Vec3 originOf(const Mat4& world_from_object) noexcept {
    return {world_from_object[12], world_from_object[13], world_from_object[14]};
}

Vec3 axisOf(const Mat4& world_from_object, std::size_t axis) noexcept {
    Vec3 out{world_from_object[4 * axis], world_from_object[4 * axis + 1], world_from_object[4 * axis + 2]};
    const double length = std::hypot(out[0], out[1], out[2]);
    if (!(length > 0) || !std::isfinite(length)) {
        Vec3 unit{};
        unit[axis] = 1;
        return unit;
    }
    for (double& component : out) {
        component /= length;
    }
    return out;
}

Mat4 placedAt(const Mat4& world_from_object, const Vec3& world) noexcept {
    Mat4 out = world_from_object;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!std::isnan(world[axis])) {
            out[12 + axis] = std::clamp(world[axis], -kFarthestPlace, kFarthestPlace);
        }
    }
    return out;
}

Mat4 moved(const Mat4& world_from_object, const Vec3& mm, Axes axes) noexcept {
    Vec3 at = originOf(world_from_object);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3 along{};
        along[axis] = 1;
        if (axes == Axes::Own) {
            along = axisOf(world_from_object, axis);
        }
        for (std::size_t i = 0; i < 3; ++i) {
            at[i] += mm[axis] * along[i];
        }
    }
    return placedAt(world_from_object, at);
}

Mat4 turned(const Mat4& world_from_object, std::size_t axis, double degrees, Axes axes) noexcept {
    Vec3 about{};
    about[axis] = 1;
    if (axes == Axes::Own) {
        about = axisOf(world_from_object, axis);
    }
    return turnedAbout(world_from_object, about, degrees);
}

Mat4 turnedAbout(const Mat4& world_from_object, const Vec3& axis, double degrees) noexcept {
    return placedAt(multiply(rotation(axis, degrees), world_from_object), originOf(world_from_object));
}

Vec3 anglesOf(const Mat4& world_from_object) noexcept {
    // The rotation of a pose, even with scale and shear; it turns with the pose.
    const Vec3 x = axisOf(world_from_object, 0);
    const Vec3 z = upright(x, axisOf(world_from_object, 1));
    const Vec3 y = cross(z, x);
    const double level = std::hypot(x[0], x[1]);
    const double aboutY = std::atan2(-x[2], level) / kDegree;
    constexpr double kUpright = 1e-9; // no more than rounding leaves
    if (level < kUpright) {
        return {std::atan2(-z[1], y[1]) / kDegree, aboutY, 0};
    }
    return {std::atan2(y[2], z[2]) / kDegree, aboutY, std::atan2(x[1], x[0]) / kDegree};
}

Vec3 anglesOf(const Mat4& world_from_object, const std::optional<TypedAngles>& typed) noexcept {
    return typed && typed->world_from_object == world_from_object ? typed->degrees : anglesOf(world_from_object);
}

Mat4 turnedTo(const Mat4& world_from_object, const Vec3& degrees) noexcept {
    const Vec3 before = anglesOf(world_from_object);
    Mat4 out = world_from_object;
    for (std::size_t i = 0; i < 3; ++i) { // back about z, y, x
        out = turned(out, 2 - i, -before[2 - i], Axes::World);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out = turned(out, axis, std::isfinite(degrees[axis]) ? degrees[axis] : before[axis], Axes::World);
    }
    return out;
}

} // namespace voxtact::view
