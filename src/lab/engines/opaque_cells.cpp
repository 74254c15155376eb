// SPDX-License-Identifier: MIT
#include "lab/engines/opaque_cells.h"

#include "core/try.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace voxtact::lab {

namespace {

/// Of a cosine: what rounding in a file's header leaves.
constexpr double kRightAngle = 1e-5;

/// The unit vectors along the axes of a grid.
struct Axes {
    std::array<Vec3, 3> along{};
    bool mirrored = false; ///< they are left-handed
};

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Result<Axes> axesOf(const Grid& grid) {
    Axes axes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::copy_n(grid.direction.begin() + static_cast<std::ptrdiff_t>(3 * axis), 3, axes.along[axis].begin());
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Vec3& one = axes.along[axis];
        if (std::abs(dot(one, one) - 1) > kRightAngle || std::abs(dot(one, axes.along[(axis + 1) % 3])) > kRightAngle) {
            return Error{ErrorCode::Unsupported, 0, "the axes of the grid are not at right angles"};
        }
    }
    const auto& [x, y, z] = axes.along;
    axes.mirrored = dot({x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]}, z) < 0;
    return axes;
}

double valueAt(const VolumeView& volume, std::size_t voxel) {
    const auto as = [&](auto scalar) {
        std::memcpy(&scalar, volume.voxels.data() + voxel * sizeof scalar, sizeof scalar);
        return static_cast<double>(scalar);
    };
    switch (volume.type) {
    case ScalarType::UInt8:
        return as(std::uint8_t{});
    case ScalarType::Int16:
        return as(std::int16_t{});
    case ScalarType::UInt16:
        return as(std::uint16_t{});
    case ScalarType::Float32:
        break;
    }
    return as(float{});
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
Mat4 worldFromCells(const Grid& grid, const Axes& axes) {
    const double first = axes.mirrored ? grid.size[0] - 0.5 : -0.5;
    const Vec3 corner = transformPoint(worldFromIndex(grid), {first, -0.5, -0.5});
    Mat4 matrix = translation(corner);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t row = 0; row < 3; ++row) {
            matrix[4 * axis + row] = axes.along[axis][row] * (axis == 0 && axes.mirrored ? -1 : 1);
        }
    }
    return matrix;
}

} // namespace

bool IsOpaque::operator()(double value) const {
    const auto last = static_cast<double>(table_.size() - 1);
    const double entry = std::clamp((value - domain_.lo) / (domain_.hi - domain_.lo) * (last + 1) - 0.5, 0.0, last);
    const auto below = static_cast<std::size_t>(entry);
    const std::size_t above = std::min(below + 1, table_.size() - 1);
    const double part = entry - std::floor(entry);
    return (1 - part) * static_cast<double>(table_[below]) + part * static_cast<double>(table_[above]) >= threshold_;
}

Result<OpaqueCells> opaqueCells(const VolumeView& volume, const TransferFunctionDesc& function, double threshold) {
    const Result<Axes> axes = axesOf(volume.grid);
    VOXTACT_TRY(axes);
    Result<std::vector<float>> table = sampleTable(function);
    VOXTACT_TRY(table);
    const IsOpaque isOpaque(std::move(*table), function.domain, threshold);
    const Vec3& spacing = volume.grid.spacing;
    OpaqueCells cells;
    cells.side = *std::ranges::min_element(spacing);
    cells.resampled = *std::ranges::max_element(spacing) > cells.side * (1 + kRightAngle);
    cells.world_from_cells = worldFromCells(volume.grid, *axes);
    std::array<std::vector<std::uint32_t>, 3> voxels;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        voxels[axis] = voxelsOfCells(volume.grid, axis, cells.side, axis == 0 && axes->mirrored);
        cells.size[axis] = static_cast<std::uint32_t>(voxels[axis].size());
    }
    cells.opaque.reserve(voxels[0].size() * voxels[1].size() * voxels[2].size());
    for (const std::size_t z : voxels[2]) {
        for (const std::size_t y : voxels[1]) {
            const std::size_t row = (z * volume.grid.size[1] + y) * volume.grid.size[0];
            for (const std::size_t x : voxels[0]) {
                cells.opaque.push_back(isOpaque(valueAt(volume, row + x)));
            }
        }
    }
    return cells;
}

} // namespace voxtact::lab
