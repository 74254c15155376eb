// SPDX-License-Identifier: MIT
#include "bench/engines/opaque_cells.h"

#include "core/base/try.h"
#include "core/transfer/opaque_intervals.h"
#include "core/volume/voxel_visit.h"

#include <glm/glm.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::lab {

namespace {

/// Error of a cosine by rounding in a file's header.
constexpr double kRightAngle = 1e-5;

/// Columns: the unit vectors along the axes of a grid.
Result<glm::dmat3> axesOf(const Grid& grid) {
    const glm::dmat3 axes = glm::make_mat3(grid.direction.data());
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        if (std::abs(glm::dot(axes[axis], axes[axis]) - 1) > kRightAngle ||
            std::abs(glm::dot(axes[axis], axes[(axis + 1) % 3])) > kRightAngle) {
            return Error{ErrorCode::Unsupported, 0, "the axes of the grid are not at right angles"};
        }
    }
    return axes;
}

double valueAt(const VolumeView& volume, std::size_t voxel) {
    return visitVoxels(volume, [voxel](const auto* voxels) { return static_cast<double>(voxels[voxel]); });
}

/// The voxels at the centres of the cells of an axis.
std::vector<std::uint32_t> voxelsOfCells(const Grid& grid, std::size_t axis, double side, bool backwards) {
    const std::uint32_t voxels = grid.size[axis];
    const auto cells = static_cast<std::uint32_t>(std::ceil(voxels * grid.spacing[axis] / side - kRightAngle));
    std::vector<std::uint32_t> out(cells);
    for (std::uint32_t cell = 0; cell < cells; ++cell) {
        const auto voxel = static_cast<std::uint32_t>((cell + 0.5) * side / grid.spacing[axis]);
        out[cell] = std::min(voxel, voxels - 1);
        if (backwards) {
            out[cell] = voxels - 1 - out[cell];
        }
    }
    return out;
}

/// From the outermost corner of the grid, along its axes; the first of them backwards where they are mirrored.
Mat4 worldFromCells(const Grid& grid, const glm::dmat3& axes, bool mirrored) {
    const double first = mirrored ? grid.size[0] - 0.5 : -0.5;
    Mat4 matrix = translation(transformPoint(worldFromIndex(grid), {first, -0.5, -0.5}));
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        const glm::dvec3 along = axes[axis] * (axis == 0 && mirrored ? -1.0 : 1.0);
        std::copy_n(glm::value_ptr(along), 3, matrix.begin() + 4 * axis);
    }
    return matrix;
}

} // namespace

Result<OpaqueCells> opaqueCells(const VolumeView& volume, const TransferFunctionDesc& function, double threshold) {
    const Result<glm::dmat3> axes = axesOf(volume.grid);
    VOXTACT_TRY(axes);
    const bool mirrored = glm::determinant(*axes) < 0;
    const OpaqueIntervals intervals(function.points, threshold);
    const Vec3& spacing = volume.grid.spacing;
    OpaqueCells cells;
    cells.side = *std::ranges::min_element(spacing);
    cells.resampled = *std::ranges::max_element(spacing) > cells.side * (1 + kRightAngle);
    cells.world_from_cells = worldFromCells(volume.grid, *axes, mirrored);
    std::array<std::vector<std::uint32_t>, 3> voxels;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        voxels[axis] = voxelsOfCells(volume.grid, axis, cells.side, axis == 0 && mirrored);
        cells.size[axis] = static_cast<std::uint32_t>(voxels[axis].size());
    }
    cells.opaque.reserve(voxels[0].size() * voxels[1].size() * voxels[2].size());
    for (const std::size_t z : voxels[2]) {
        for (const std::size_t y : voxels[1]) {
            const std::size_t row = (z * volume.grid.size[1] + y) * volume.grid.size[0];
            for (const std::size_t x : voxels[0]) {
                const double value = valueAt(volume, row + x);
                cells.opaque.push_back(intervals.contain(value, value));
            }
        }
    }
    return cells;
}

} // namespace voxtact::lab
