// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace voxtact::lab {

/// The opaque voxels of a volume as cubes, which is how an octree has them.
struct OpaqueCells {
    std::array<std::uint32_t, 3> size{}; ///< cells
    double side = 0;                     ///< mm: the smallest spacing
    Mat4 world_from_cells{};             ///< rigid; cell (i, j, k) is from (i, j, k) * side to one side further on
    std::vector<bool> opaque;            ///< x fastest
    bool resampled = false;              ///< the voxels are no cubes: a cell has the value of the voxel at its centre
};

/// Unsupported where the axes of the grid are not at right angles. Expects a volume that checkVolume() accepts.
[[nodiscard]] Result<OpaqueCells> opaqueCells(const VolumeView& volume, const TransferFunctionDesc& function,
                                              double threshold);

} // namespace voxtact::lab
