// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/document/pose.h"
#include "viewer/model/shown/camera.h"

#include <array>

/// Handles at the instrument's origin that move and turn it. Pure functions; world space, mm.
namespace voxtact::view {

/// Along `direction`, of unit length, into the picture.
struct Ray {
    Vec3 origin{};
    Vec3 direction{0, 0, 1};
};
/// Ray of a pixel in the camera's picture.
[[nodiscard]] Ray rayThrough(const Camera& camera, const Extent& extent, double x, double y) noexcept;

/// The axes of the handles.
enum class GizmoAxes { World, View, Own };
/// Returns the next one, cyclically.
[[nodiscard]] constexpr GizmoAxes nextOf(GizmoAxes axes) noexcept {
    return axes == GizmoAxes::Own ? GizmoAxes::World : static_cast<GizmoAxes>(static_cast<int>(axes) + 1);
}

struct Gizmo {
    Vec3 at{};                  ///< the object's origin
    std::array<Vec3, 3> axes{}; ///< of unit length, at right angles to each other
    double size = 1;            ///< mm: the length of an arrow
};
/// Gizmo of an instrument; for shearing poses, own axes are those of its rotation.
[[nodiscard]] Gizmo gizmoOf(const Mat4& world_from_object, const Camera& camera, GizmoAxes axes, double size) noexcept;

/// Arrows along an axis, squares across it, rings round it.
enum class HandleKind { None, Arrow, Square, Ring };
struct Handle {
    HandleKind kind = HandleKind::None;
    std::size_t axis = 0;

    [[nodiscard]] bool operator==(const Handle&) const = default;
};

// Parts of the size.
inline constexpr double kArrowBegin = 0.2;
inline constexpr double kSquareBegin = 0.3;
inline constexpr double kSquareEnd = 0.5;
inline constexpr double kRingRadius = 0.8;

/// Returns true if a square or ring is too edge-on to be taken.
[[nodiscard]] bool edgeOn(const Gizmo& gizmo, std::size_t axis, const Vec3& direction) noexcept;

/// Returns the handle under a ray: the nearest arrow or ring within `reach` mm, else a square.
[[nodiscard]] Handle handleAt(const Gizmo& gizmo, const Ray& ray, double reach) noexcept;

/// Step sizes of a drag; 0: none.
struct Snap {
    double millimetres = 0;
    double degrees = 0;
};

/// Returns the pose `world_from_object` after dragging a handle from one ray to another: the point under the first
/// moves to the second, as far as the handle allows. Returns the same pose if undefined.
[[nodiscard]] Mat4 dragged(const Mat4& world_from_object, const Gizmo& gizmo, const Handle& handle, const Ray& from,
                           const Ray& to, const Snap& snap) noexcept;

} // namespace voxtact::view
