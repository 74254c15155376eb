// SPDX-License-Identifier: MIT
#include "core/edit_rows.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact {

namespace {

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double length(const Vec3& a) {
    return std::hypot(a[0], a[1], a[2]);
}

/// Voxel numbers along an axis.
struct Span {
    std::uint32_t first = 0;
    std::uint32_t end = 0;
};

/// The numbers from `lo` to `hi` of an axis with `size` voxels. NaN is taken for no limit.
Span numbersWithin(double lo, double hi, std::uint32_t size) {
    const double most = size;
    const double first = lo > 0 ? std::min(std::ceil(lo), most) : 0;
    const double end = hi < most - 1 ? std::max(std::floor(hi) + 1, 0.0) : most;
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(std::max(first, end))};
}

/// A radius whose square would be too large, and a power of two that makes it small enough.
constexpr double kLarge = 1e100;
constexpr double kShrink = 0x1p-600;

class BallRows {
  public:
    BallRows(const Ball& ball, const Grid& grid)
        : ball_(ball), grid_(grid), world_from_index_(worldFromIndex(grid)),
          scale_(ball.radius > kLarge ? kShrink : 1) {
        const Vec3 step{world_from_index_[0], world_from_index_[1], world_from_index_[2]};
        stepLength_ = length(step);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            along_[axis] = step[axis] / stepLength_;
        }
    }

    /// Voxels of an axis between which the ball lies, generously.
    [[nodiscard]] Span reach(std::size_t axis, const Mat4& texture_from_world) const {
        const double voxels = grid_.size[axis];
        const double at = transformPoint(texture_from_world, ball_.centre)[axis] * voxels - 0.5;
        const Vec3 row{texture_from_world[axis], texture_from_world[4 + axis], texture_from_world[8 + axis]};
        const double half = ball_.radius * length(row) * voxels * 1.001 + 1;
        return numbersWithin(at - half, at + half, grid_.size[axis]);
    }

    /// Where the line of voxel centres is within the ball: a span by construction, whatever rounds. In squares, so that
    /// what is exact in whole voxels stays exact.
    [[nodiscard]] Span row(std::uint32_t y, std::uint32_t z) const {
        Vec3 toCentre{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            toCentre[axis] = (ball_.centre[axis] - (world_from_index_[12 + axis] + world_from_index_[4 + axis] * y +
                                                    world_from_index_[8 + axis] * z)) *
                             scale_;
        }
        const double nearest = dot(toCentre, along_);
        const Vec3 across{toCentre[0] - nearest * along_[0], toCentre[1] - nearest * along_[1],
                          toCentre[2] - nearest * along_[2]};
        const double radius = ball_.radius * scale_;
        const double squared = radius * radius - dot(across, across);
        if (!(squared >= 0)) {
            return {};
        }
        const double half = std::sqrt(squared);
        const double step = stepLength_ * scale_;
        return numbersWithin((nearest - half) / step, (nearest + half) / step, grid_.size[0]);
    }

  private:
    const Ball& ball_;
    const Grid& grid_;
    Mat4 world_from_index_;
    double scale_;          ///< of all lengths, so that no square overflows
    double stepLength_ = 0; ///< mm from one voxel to the next of its row
    Vec3 along_{};          ///< unit vector along a row
};

std::vector<VoxelRow> rowsOf(const VoxelBox& box, const Grid&) {
    std::vector<VoxelRow> rows;
    for (std::uint32_t z = 0; z < box.size[2]; ++z) {
        for (std::uint32_t y = 0; y < box.size[1] && box.size[0] > 0; ++y) {
            rows.push_back({box.first[1] + y, box.first[2] + z, box.first[0], box.first[0] + box.size[0]});
        }
    }
    return rows;
}

std::vector<VoxelRow> rowsOf(const Ball& ball, const Grid& grid) {
    const BallRows within(ball, grid);
    const Mat4 texture_from_world = textureFromWorld(grid).value();
    const Span spanY = within.reach(1, texture_from_world);
    const Span spanZ = within.reach(2, texture_from_world);
    std::vector<VoxelRow> rows;
    for (std::uint32_t z = spanZ.first; z < spanZ.end; ++z) {
        for (std::uint32_t y = spanY.first; y < spanY.end; ++y) {
            if (const Span span = within.row(y, z); span.first < span.end) {
                rows.push_back({y, z, span.first, span.end});
            }
        }
    }
    return rows;
}

} // namespace

std::vector<VoxelRow> voxelRows(const VoxelRegion& region, const Grid& grid) {
    return std::visit([&](const auto& shape) { return rowsOf(shape, grid); }, region);
}

VoxelBox boundsOf(const std::vector<VoxelRow>& rows) noexcept {
    if (rows.empty()) {
        return {};
    }
    std::array<std::uint32_t, 3> first{rows.front().firstX, rows.front().y, rows.front().z};
    std::array<std::uint32_t, 3> end = first;
    for (const VoxelRow& row : rows) {
        first = {std::min(first[0], row.firstX), std::min(first[1], row.y), std::min(first[2], row.z)};
        end = {std::max(end[0], row.endX), std::max(end[1], row.y + 1), std::max(end[2], row.z + 1)};
    }
    return {first, {end[0] - first[0], end[1] - first[1], end[2] - first[2]}};
}

} // namespace voxtact
