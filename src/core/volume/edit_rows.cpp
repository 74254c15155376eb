// SPDX-License-Identifier: MIT
#include "core/volume/edit_rows.h"
#include "core/volume/ball_rows.h"

#include <algorithm>
#include <array>

namespace voxtact {

namespace {

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
    return ballRows(ball, grid);
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
