// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// The geometry of the oracle: clipping, snapping, coverage, and how far from all that another rasteriser can be.
namespace voxtact::oracle {

/// The relative error of one rounding to float.
inline constexpr double kFloatRounding = 1.0 / 16777216;
/// A corner's roundings, at most: the product of the matrices (1), the sum of four terms (4), cutting at planes (4).
inline constexpr double kCornerRoundings = 12;
inline constexpr double kSubPixels = 256;

/// A corner of a triangle before the division by w. All of it is linear along an edge, the bounds on rounding too:
/// a far corner's large error counts for little near the other end.
struct Corner {
    std::array<double, 4> clip{};
    Vec3 texture{};
    std::array<double, 4> clipError{}; ///< of clip in single precision
    Vec3 textureError{};
};

/// A corner on the screen.
struct ScreenCorner {
    std::int64_t x = 0; ///< 1/256 pixels
    std::int64_t y = 0;
    double exactX = 0; ///< pixels, before snapping
    double exactY = 0;
    double w = 1;
    Vec3 texture{};
    double drift = 0; ///< pixels by which single precision may move it, snapping aside
    Vec3 textureError{};
};

/// What the view volume leaves of a triangle: a convex polygon, up to snapping. It may have no area, or no corner.
struct Polygon {
    std::vector<ScreenCorner> corners;
    bool undivided = false; ///< a corner's w is zero up to rounding: the polygon could be anywhere
};

using Triangle = std::array<Corner, 3>;

/// A box in texture space.
struct TextureBox {
    Vec3 lo{};
    Vec3 hi{};
};

[[nodiscard]] Corner makeCorner(const Mat4& clip_from_object, const Mat4& texture_from_object, const Vec3& position);

/// Projects a triangle along the axis of the largest component of its normal in voxel space, onto a square viewport of
/// the longest side of the image. One without a normal is put outside of it.
void projectAlongDominantAxis(Triangle& triangle, const std::array<std::uint32_t, 3>& size);

/// Which view volume to clip to: the true one, or one that single precision could at most, or must at least, see.
enum class ViewVolume : std::uint32_t { True, Widened, Narrowed };
[[nodiscard]] Polygon clipAndSnap(const Triangle& triangle, const View& view, ViewVolume volume);

/// The texture coordinate at the centre of a pixel that the polygon covers; nothing where it does not.
[[nodiscard]] std::optional<Vec3> coordinateWhereCovered(const Polygon& polygon, std::uint32_t x, std::uint32_t y);
/// Where the ray through the pixel's centre meets the plane of the triangle; the triangle's centre if that is edge-on.
[[nodiscard]] Vec3 extrapolatedCoordinate(const Triangle& triangle, const View& view, std::uint32_t x, std::uint32_t y);

/// Pixels from the centre of a pixel to the polygon's outline, without a sign; infinity if there is none.
[[nodiscard]] double outlineDistance(const Polygon& polygon, std::uint32_t x, std::uint32_t y);
/// Whether the outline may pass through the centre when its points move by `pixels` and their drift.
[[nodiscard]] bool outlineMayPass(const Polygon& polygon, std::uint32_t x, std::uint32_t y, double pixels);

/// Bounds of the coordinates that a rasteriser can find at the pixel whose corners are within `pixels`, their drift and
/// rounding of the polygon's. Nothing where it cannot cover the pixel.
///
/// Such a rasteriser samples, at the pixel's centre P, the coordinate that the polygon has at a point Q: the same
/// convex combination of its own corners that P is of the moved ones. So Q is in the polygon, and no farther from P
/// than a corner moves. Nothing is extrapolated, and a sliver gives no more than its own coordinates.
[[nodiscard]] std::optional<TextureBox> reachableCoordinates(const Polygon& polygon, const View& view, std::uint32_t x,
                                                             std::uint32_t y, double pixels);
[[nodiscard]] TextureBox coordinatesOf(const Triangle& triangle);

/// How far a rasteriser that interpolates by a plane equation in single precision, anchored at the viewport's corner,
/// may be off, as a share of the triangle's extent in texture space. Both its parts grow as the triangle gets thin: the
/// area loses its digits, and the gradient is multiplied by the distance from the anchor. The plane may be that of the
/// corners before or after snapping.
[[nodiscard]] double planeError(const Polygon& polygon, const View& view);

} // namespace voxtact::oracle
