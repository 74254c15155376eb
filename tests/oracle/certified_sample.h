// SPDX-License-Identifier: MIT
#pragma once

#include "oracle/certified_cut.h"
#include "voxtact/data.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// The look-ups of the certified oracle, as bounds: double precision, with everything that it rounds counted in.
/// Places are in index space, voxel i's centre at i; cell i of an axis is [i, i+1], from -1 to n-1.
namespace voxtact::oracle::certified {

/// Distance of 1 to the next double.
inline constexpr double kRounding = 0x1p-52;

using Cell = std::array<std::int64_t, 3>;
/// The voxel with the lowest numbers first, x fastest.
using CellVoxels = std::array<double, 8>;

/// The trilinear interpolant of an image, clamped to the outermost voxel centres.
class Field {
  public:
    /// `range` as checkVolume() gives it.
    Field(const VolumeView& volume, const ValueRange& range);

    [[nodiscard]] const std::array<std::uint32_t, 3>& size() const noexcept { return size_; }
    /// Outside the image: the nearest voxel.
    [[nodiscard]] CellVoxels voxelsOf(const Cell& cell) const;
    /// Holds the value at every place within `error` of this one, along each axis.
    [[nodiscard]] ValueRange at(const Vec3& place, double error) const;
    /// Holds the values of the cell's interpolant at every place within `error` of the triangle, which leaves the cell
    /// by no more than that.
    [[nodiscard]] ValueRange over(const CellVoxels& voxels, const Cell& cell, const Corners& triangle,
                                  double error) const;
    /// How far `at` may be off to either side.
    [[nodiscard]] double doubt(double error) const noexcept { return rounding_ + slope_ * error; }

  private:
    [[nodiscard]] ValueRange widened(double lo, double hi, double error) const;

    std::array<std::uint32_t, 3> size_;
    std::vector<double> voxels_;
    ValueRange range_;
    double slope_;    ///< no two values that are one voxel apart along each axis differ by more
    double rounding_; ///< of an interpolation
};

/// Value -> opacity, linear between the control points and constant beyond them; at a step the greatest counts.
class Opacity {
  public:
    Opacity(std::span<const ControlPoint> points, double threshold)
        : points_(points.begin(), points.end()), threshold_(threshold) {}

    /// False: not one of the values is opaque.
    [[nodiscard]] bool mayBeOpaque(const ValueRange& values) const;
    /// True: all of the values are opaque.
    [[nodiscard]] bool allOpaque(const ValueRange& values) const;
    /// An opaque value not below `lo` and not above `hi`; nothing where none is certain.
    [[nodiscard]] std::optional<double> opaqueBetween(double lo, double hi) const;

  private:
    /// The opacities on the line from point i to the next that two values on it have, or may have by rounding.
    [[nodiscard]] ValueRange between(std::size_t i, double lo, double hi) const;

    std::vector<ControlPoint> points_;
    double threshold_;
};

} // namespace voxtact::oracle::certified
