// SPDX-License-Identifier: MIT
#pragma once

#include "view/model/slice.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

/// Handles round the instrument's tip: arrows that move it along three axes, and rings that turn it about them. Pure
/// functions; poses are `world_from_object`. Pixels are a picture's, from its upper left corner.
namespace voxtact::view {

enum class Handle { Arrow, Ring };

/// One of the six.
struct GizmoPart {
    Handle handle = Handle::Arrow;
    std::size_t axis = 0;

    [[nodiscard]] bool operator==(const GizmoPart&) const = default;
};

/// Where the handles are, and how large.
struct Gizmo {
    Vec3 centre{};              ///< world, mm
    std::array<Vec3, 3> axes{}; ///< world, of unit length
    double size = 1;            ///< mm: the arrows' length, and the rings' radius
};

inline constexpr double kGizmoPixels = 70; ///< the arrows' length
inline constexpr double kGizmoReach = 7;   ///< pixels from a handle at which it is taken
inline constexpr std::size_t kRingPieces = 48;

/// Round the object's origin, along its own axes or the world's, as large as kGizmoPixels whatever the zoom.
/// `pixel`: millimetres of one.
[[nodiscard]] Gizmo gizmoOf(const Mat4& world_from_object, bool ownAxes, double pixel) noexcept;

/// What is seen orthographically: the line of points under a pixel.
struct Ray {
    Vec3 origin{};
    Vec3 direction{}; ///< of unit length, away from the eye
};
[[nodiscard]] Ray rayThrough(const Camera& camera, const Extent& extent, const Point2& pixel) noexcept;

/// Corners of a ring, kRingPieces of them.
[[nodiscard]] std::vector<Vec3> ringOf(const Gizmo& gizmo, std::size_t axis);
/// The end of an arrow.
[[nodiscard]] Vec3 tipOf(const Gizmo& gizmo, std::size_t axis) noexcept;

/// Whether a handle can be dragged as it is seen: an arrow not from its end, a ring not from its side.
[[nodiscard]] bool isUsable(const Gizmo& gizmo, const GizmoPart& part, const Ray& ray) noexcept;

/// The handle that the ray comes nearest to, where it is nearer than `reach` mm. Only usable ones.
[[nodiscard]] std::optional<GizmoPart> partUnder(const Gizmo& gizmo, const Ray& ray, double reach);

/// A drag, from where it began.
struct GizmoDrag {
    Gizmo gizmo;
    GizmoPart part;
    Mat4 pose{};
    Ray from;
};

/// The pose when a drag has come to a ray: an arrow follows the point on its axis that is nearest to the ray, a ring
/// the angle at which the ray meets its plane.
[[nodiscard]] Mat4 dragged(const GizmoDrag& drag, const Ray& to);

} // namespace voxtact::view
