// SPDX-License-Identifier: MIT
#pragma once

#include "core/volume/edit_rows.h"

namespace voxtact {

/// The voxels of a ball, as voxelRows() says. A voxel belongs to it when its centre, origin + direction * (spacing *
/// number), is no farther from the ball's than the radius, of the numbers as they are: nothing rounds. Each voxel is
/// decided in double where that is certain, and by ExactNumber where it is not.
[[nodiscard]] std::vector<VoxelRow> ballRows(const Ball& ball, const Grid& grid);

} // namespace voxtact
