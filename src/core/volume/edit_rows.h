// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <vector>

namespace voxtact {

/// Voxels in a row along x.
struct VoxelRow {
    std::uint32_t y = 0;
    std::uint32_t z = 0;
    std::uint32_t firstX = 0;
    std::uint32_t endX = 0; ///< beyond the last one; greater than firstX
};

/// Returns the voxels of a region, by ascending z, then y; at most one row for each. This function defines the voxels
/// of a region for host and device. Expects a region that voxelBounds() accepts.
[[nodiscard]] std::vector<VoxelRow> voxelRows(const VoxelRegion& region, const Grid& grid);

/// Returns the smallest box that contains all of them.
[[nodiscard]] VoxelBox boundsOf(const std::vector<VoxelRow>& rows) noexcept;

} // namespace voxtact
