// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <array>
#include <cstdint>
#include <variant>

/// Regions of a volume that are changed in place: drilling, painting, streaming.
namespace voxtact {

/// A box of voxels.
struct VoxelBox {
    std::array<std::uint32_t, 3> first{}; ///< the lowest corner
    std::array<std::uint32_t, 3> size{};  ///< voxels along each axis; 0: empty
};

/// The voxels whose centre is at most a distance (mm) from a point, by exact arithmetic on these and the grid.
struct Ball {
    Vec3 centre{};     ///< world, mm
    double radius = 0; ///< mm; not negative
};

/// What an edit changes.
using VoxelRegion = std::variant<VoxelBox, Ball>;

/// The least box with all voxels of a region that lie in the grid; a Ball may reach over the grid's faces and be empty.
/// Refuses a VoxelBox that leaves the grid, and a Ball that is not finite or has a negative radius.
[[nodiscard]] VOXTACT_API Result<VoxelBox> voxelBounds(const VoxelRegion& region, const Grid& grid);

} // namespace voxtact
