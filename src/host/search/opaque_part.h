// SPDX-License-Identifier: MIT
#pragma once

#include "core/transfer/opaque_intervals.h"
#include "host/search/cells/cell_piece.h"
#include "host/search/cells/volume_space.h"
#include "host/touch/cells/certified_occupancy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// A place in a pyramid.
using NodePlace = std::array<std::int32_t, 3>;

/// The tested bricks, and above them boxes of 2^3, 4^3, ... bricks with at least one of them, up to one box.
class BrickPyramid {
  public:
    BrickPyramid() = default;
    /// `wanted` is not zero for the bricks that are examined.
    BrickPyramid(const std::array<std::int32_t, 3>& count, std::vector<std::uint8_t> wanted);

    /// Level 0 are the bricks.
    [[nodiscard]] std::uint32_t levels() const noexcept { return static_cast<std::uint32_t>(levels_.size()); }
    /// Returns false outside the volume.
    [[nodiscard]] bool has(std::uint32_t level, const NodePlace& node) const noexcept {
        const Level& at = levels_[level];
        return node[0] < at.count[0] && node[1] < at.count[1] && node[2] < at.count[2] &&
               at.wanted[numberOf(at.count, node)] != 0;
    }

  private:
    struct Level {
        NodePlace count{};
        std::vector<std::uint8_t> wanted;
    };
    [[nodiscard]] static std::size_t numberOf(const NodePlace& count, const NodePlace& node) noexcept {
        return (static_cast<std::size_t>(node[2]) * static_cast<std::size_t>(count[1]) +
                static_cast<std::size_t>(node[1])) *
                   static_cast<std::size_t>(count[0]) +
               static_cast<std::size_t>(node[0]);
    }

    std::vector<Level> levels_;
};

/// Maximum error of an interpolated value after a dozen roundings, relative to the largest voxel, with the same margin
/// for the computed terms. In double: single precision would limit the bounds.
inline constexpr double kValueError = 0x1p-47;
/// Returns the error in a cell whose voxels are from `lo` to `hi`; interpolation between equal voxels is exact.
[[nodiscard]] inline double valueError(double lo, double hi) noexcept {
    return lo < hi ? kValueError * std::max(std::abs(lo), std::abs(hi)) : 0;
}

/// Data of a cell for the search.
struct PartCell {
    Trilinear terms{};
    double error = 0;    ///< of a value
    glm::dvec3 middle{}; ///< of the cell, centred voxel coordinates
    glm::dvec3 domain{}; ///< the middle of its part in the domain, in the cell's coordinates from -1 to 1
    glm::dvec3 half{1};  ///< half the sides of that part
};

struct PieceRows;

/// One volume under one transfer function, threshold and resolution, for distance queries at all poses. Thread-safe.
class OpaquePart {
  public:
    OpaquePart(const VolumeImpl& volume, const TransferFunctionImpl& function, double threshold, double resolution);

    /// `volume` below is that of the constructor.
    [[nodiscard]] const BrickCells& cells(const VolumeImpl& volume, const NodePlace& brick) const {
        return occupancy.cells(volume, brick);
    }
    /// The cell with this padded number (core/volume/bricks.h), which is not further out than the last one.
    [[nodiscard]] PartCell cell(const VolumeImpl& volume, const NodePlace& padded) const;
    /// Returns the range of the corners' stored values.
    [[nodiscard]] ValueRange cornerRange(const VolumeImpl& volume, const NodePlace& padded) const;
    /// Returns a cell with its position only.
    [[nodiscard]] PartCell emptyCell(const VolumeImpl& volume, const NodePlace& padded) const {
        PartCell out;
        setDomain(volume, padded, out);
        return out;
    }
    /// Adds all of such a cell to some rows, for makeTerms().
    void addCell(const VolumeImpl& volume, const NodePlace& padded, PieceRows& rows) const;

    CertifiedOccupancy occupancy;
    VolumeSpace space;
    OpaqueIntervals intervals; ///< of stored values
    BrickPyramid pyramid;
    ValueRange storedRange; ///< of all voxels

  private:
    void setDomain(const VolumeImpl& volume, const NodePlace& padded, PartCell& cell) const {
        for (int axis = 0; axis < 3; ++axis) {
            const std::int32_t number = padded[static_cast<std::size_t>(axis)] - 1;
            cell.middle[axis] = number + 0.5 - space.centre[axis];
            const bool first = number < 0;
            const bool last = number == volume.image.size[static_cast<std::size_t>(axis)] - 1;
            cell.domain[axis] = (first ? 0.5 : 0.0) - (last ? 0.5 : 0.0);
            cell.half[axis] = 1 - (first ? 0.5 : 0.0) - (last ? 0.5 : 0.0);
        }
    }
};

} // namespace voxtact::cpu
