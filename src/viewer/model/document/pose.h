// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>
#include <optional>

/// Small moves of an instrument. Pure functions; poses are `world_from_object`.
namespace voxtact::view {

/// The axes of a move.
enum class Axes { World, Own };

/// Returns the pose moved by `mm` along the world's axes, or along the object's own axes (of unit length for any
/// scale).
[[nodiscard]] Mat4 moved(const Mat4& world_from_object, const Vec3& mm, Axes axes) noexcept;

/// Returns the pose turned by `degrees` about axis 0, 1 or 2, counter-clockwise seen against the axis. The object's
/// origin, the tip of builtin instruments, stays in place.
[[nodiscard]] Mat4 turned(const Mat4& world_from_object, std::size_t axis, double degrees, Axes axes) noexcept;

/// Like turned(), about a unit axis in world space.
[[nodiscard]] Mat4 turnedAbout(const Mat4& world_from_object, const Vec3& axis, double degrees) noexcept;

/// mm along an axis: maximum of typed and dragged positions.
inline constexpr double kFarthestPlace = 1e12;

/// Returns the pose with the object's origin at a world point, limited to kFarthestPlace. Coordinates that are not
/// finite stay.
[[nodiscard]] Mat4 placedAt(const Mat4& world_from_object, const Vec3& world) noexcept;

/// Position of the object's origin, mm.
[[nodiscard]] Vec3 originOf(const Mat4& world_from_object) noexcept;

/// Returns the object's own axis in the world, of unit length; the world's axis if it has no length.
[[nodiscard]] Vec3 axisOf(const Mat4& world_from_object, std::size_t axis) noexcept;

/// Rotation of the object in degrees: about x, then y, then z of the world. For shearing poses, that of the x axis, and
/// of the y axis orthogonalised to it. If x points along the world's z, z is 0.
[[nodiscard]] Vec3 anglesOf(const Mat4& world_from_object) noexcept;

/// Typed angles and their pose, which other angles would give, too.
struct TypedAngles {
    Mat4 world_from_object{};
    Vec3 degrees{};
};

/// Returns the typed angles if they belong to this pose; else anglesOf(pose).
[[nodiscard]] Vec3 anglesOf(const Mat4& world_from_object, const std::optional<TypedAngles>& typed) noexcept;

/// Returns the same position and shape, rotated so that anglesOf() is `degrees`. Angles that are not finite stay.
[[nodiscard]] Mat4 turnedTo(const Mat4& world_from_object, const Vec3& degrees) noexcept;

} // namespace voxtact::view
