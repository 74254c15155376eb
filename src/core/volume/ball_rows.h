// SPDX-License-Identifier: MIT
#pragma once

#include "core/volume/edit_rows.h"

namespace voxtact {

/// Returns the rows of the voxels in a ball, like voxelRows(). A voxel belongs to the ball if its centre, origin +
/// direction * (spacing * index), is within the radius, in exact arithmetic on the given numbers. Each voxel is decided
/// in double if that is certain, else by ExactNumber.
[[nodiscard]] std::vector<VoxelRow> ballRows(const Ball& ball, const Grid& grid);

} // namespace voxtact
