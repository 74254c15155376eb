// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>
#include <optional>

/// Small moves of an instrument. Pure functions; poses are `world_from_object`.
namespace voxtact::view {

/// Whose axes a move is along.
enum class Axes { World, Own };

/// Moved by `mm` along the world's axes, or along the object's own ones (of unit length, whatever its scale).
[[nodiscard]] Mat4 moved(const Mat4& world_from_object, const Vec3& mm, Axes axes) noexcept;

/// Turned by `degrees` about axis 0, 1 or 2, counter-clockwise for who looks against it. The object's origin, which
/// is the tip of the builtin instruments, stays where it is.
[[nodiscard]] Mat4 turned(const Mat4& world_from_object, std::size_t axis, double degrees, Axes axes) noexcept;

/// The same about an axis of unit length in the world.
[[nodiscard]] Mat4 turnedAbout(const Mat4& world_from_object, const Vec3& axis, double degrees) noexcept;

/// mm along an axis: no farther is anything put, whatever is typed or dragged.
inline constexpr double kFarthestPlace = 1e12;

/// The same pose with the object's origin at a point of the world, as far as kFarthestPlace. What is not a number
/// stays.
[[nodiscard]] Mat4 placedAt(const Mat4& world_from_object, const Vec3& world) noexcept;

/// Where the object's origin is, mm.
[[nodiscard]] Vec3 originOf(const Mat4& world_from_object) noexcept;

/// The object's own axis in the world, of unit length; the world's axis where it has no length.
[[nodiscard]] Vec3 axisOf(const Mat4& world_from_object, std::size_t axis) noexcept;

/// The object turned against the world, in degrees: about x, then y, then z of the world. Of the rotation alone: that
/// of its x axis, and of its y axis as far as that stands upright on it. Where x goes along the world's z, z is 0.
[[nodiscard]] Vec3 anglesOf(const Mat4& world_from_object) noexcept;

/// Angles that were typed, and the pose that they made: others would make the same one.
struct TypedAngles {
    Mat4 world_from_object{};
    Vec3 degrees{};
};

/// Those that were typed for this pose; else the same as without.
[[nodiscard]] Vec3 anglesOf(const Mat4& world_from_object, const std::optional<TypedAngles>& typed) noexcept;

/// The same place and shape, turned so that anglesOf() is a rotation by `degrees`. An angle that is not finite stays.
[[nodiscard]] Mat4 turnedTo(const Mat4& world_from_object, const Vec3& degrees) noexcept;

} // namespace voxtact::view
