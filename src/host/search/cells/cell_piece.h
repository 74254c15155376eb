// SPDX-License-Identifier: MIT
#pragma once

#include "core/transfer/opaque_intervals.h"
#include "host/search/cells/volume_space.h"
#include "host/search/closest_point.h"

#include <glm/vec3.hpp>

#include <array>

namespace voxtact::cpu {

/// The trilinear interpolant of a box, the coefficients of the products of the coordinates that
/// go from -1 to 1 along each axis of the box; that of x * z is at 1 + 4.
using Trilinear = std::array<double, 8>;

/// `corners`: corner (x, y, z) at x + 2 * y + 4 * z.
[[nodiscard]] Trilinear trilinearOf(const std::array<double, 8>& corners) noexcept;
/// Returns the same interpolant in an inner box: its middle and half sides, in the coordinates of the outer box.
[[nodiscard]] Trilinear within(const Trilinear& whole, const glm::dvec3& middle, const glm::dvec3& half) noexcept;
[[nodiscard]] inline double valueAt(const Trilinear& whole, const glm::dvec3& at) noexcept {
    const double v00 = whole[0] + at.x * whole[1];
    const double v10 = whole[2] + at.x * whole[3];
    const double v01 = whole[4] + at.x * whole[5];
    const double v11 = whole[6] + at.x * whole[7];
    return v00 + at.y * v10 + at.z * (v01 + at.y * v11);
}
[[nodiscard]] inline glm::dvec3 gradientAt(const Trilinear& whole, const glm::dvec3& at) noexcept {
    return {whole[1] + at.y * whole[3] + at.z * (whole[5] + at.y * whole[7]),
            whole[2] + at.x * whole[3] + at.z * (whole[6] + at.x * whole[7]),
            whole[4] + at.x * whole[5] + at.y * (whole[6] + at.x * whole[7])};
}

/// Relative error of sums like those of PieceBounds::least(), of their largest terms.
inline constexpr double kSumError = 0x1p-46;

/// A box of voxel space, and two planes that enclose its opaque points: in the box's coordinates s from -1 to 1,
/// dot(slope, s) is from `from` to `to`.
struct PieceBounds {
    glm::dvec3 middle{}; ///< local
    glm::dvec3 half{};   ///< voxels
    glm::dvec3 slope{};
    glm::dvec3 inverse{}; ///< one by `slope`
    double from = 0;      ///< or minus infinity
    double to = 0;        ///< or infinity
    double size = 0;      ///< the sum of the slope's magnitudes

    /// Returns the minimum dot product of an opaque point of the box with `normal`.
    [[nodiscard]] double least(const VolumeSpace& space, const glm::dvec3& normal) const noexcept;
};

/// A box of voxel space in one cell, with bounds of its opaque points.
class CellPiece {
  public:
    /// `cell`: of the interpolant of the whole cell, whose values may be off by `error`. `middle` and
    /// `half`: the piece in the cell's coordinates. `cellMiddle`: of the cell, centred voxel coordinates.
    CellPiece(const Trilinear& cell, double error, const glm::dvec3& cellMiddle, const glm::dvec3& middle,
              const glm::dvec3& half) noexcept;

    /// Returns true if some point may be opaque. Call it before the functions below.
    [[nodiscard]] bool mayBeOpaque(const OpaqueIntervals& intervals) noexcept;
    [[nodiscard]] bool allOpaque(const OpaqueIntervals& intervals) const noexcept {
        return intervals.contain(lo_, hi_);
    }
    /// Returns true if some point is certainly opaque: by the values at the corners, and between them.
    [[nodiscard]] bool someOpaque(const OpaqueIntervals& intervals) const noexcept {
        const double twice = 2 * error_;
        return intervals.certainlyMeet(lo_ + twice, hi_ - twice) || intervals.contain(lo_, lo_ + twice) ||
               intervals.contain(hi_ - twice, hi_);
    }
    /// Returns bounds of the points that may be opaque.
    [[nodiscard]] PieceBounds bounds(const VolumeSpace& space) const noexcept;
    /// Returns the direction of steepest ascent of the interpolant, world.
    [[nodiscard]] glm::dvec3 ascent(const VolumeSpace& space) const noexcept;
    /// Returns true if the interpolant varies by less than its error: division is then useless.
    [[nodiscard]] bool isFlat() const noexcept { return !(hi_ - lo_ > 4 * error_); }
    /// Range of the interpolant in the piece, including its error.
    [[nodiscard]] double lo() const noexcept { return lo_; }
    [[nodiscard]] double hi() const noexcept { return hi_; }

    [[nodiscard]] glm::dvec3 middle() const noexcept { return middle_; } ///< centred voxel coordinates
    [[nodiscard]] glm::dvec3 half() const noexcept { return half_; }     ///< voxels

  private:
    Trilinear terms_;
    double error_;
    double lo_ = 0;
    double hi_ = 0;
    glm::dvec3 middle_;
    glm::dvec3 half_;
    ValueRange hull_;
};

} // namespace voxtact::cpu
