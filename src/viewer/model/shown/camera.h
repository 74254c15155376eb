// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/looks.h"

#include <cstdint>

/// Camera of the large picture: orthographic, around a target point.
namespace voxtact::view {

/// mm: limits of Camera::halfHeight.
inline constexpr double kLeastHalfHeight = 0.01;
inline constexpr double kMostHalfHeight = 1e6;

struct Camera {
    Vec3 target{};           ///< world, mm: in the picture's middle
    ViewDirection direction; ///< direction to the eye
    double halfHeight = 100; ///< mm from the picture's middle to its upper edge
};

/// Pixels of a picture.
struct Extent {
    std::uint32_t width = 1;
    std::uint32_t height = 1;
};

/// Returns a camera that frames a volume from a direction.
[[nodiscard]] Camera framing(const Grid& grid, const ViewDirection& direction) noexcept;

/// Rotates by a drag in pixels: a picture's height is half a turn. Limits the elevation to -90..90.
void orbit(Camera& camera, double right, double down, const Extent& extent) noexcept;
/// Keeps the point under the pointer there.
void pan(Camera& camera, double right, double down, const Extent& extent) noexcept;
/// Zooms by a factor, below 1 nearer; keeps the point at pixel x, y there.
void zoom(Camera& camera, double factor, double x, double y, const Extent& extent) noexcept;

/// `depth`: visible mm before and behind the target.
[[nodiscard]] Mat4 clipFromWorld(const Camera& camera, const Extent& extent, double depth) noexcept;

/// Millimetres of a pixel.
[[nodiscard]] double millimetresOfPixel(const Camera& camera, const Extent& extent) noexcept;

/// Returns the length of a scale bar: 1, 2 or 5 times a power of ten millimetres, at most `most`.
[[nodiscard]] double barLength(double most) noexcept;

} // namespace voxtact::view
