// SPDX-License-Identifier: MIT
#pragma once

#include "device/scene/scene_impl.h"
#include "voxtact/data.h"

namespace voxtact {

/// Makes the buffer of a volume's bricks, not yet filled, and what the brick pass needs. LimitExceeded beyond the
/// device's storage buffers.
[[nodiscard]] Result<void> makeBricks(VolumeImpl& volume, const char* name);

/// Records the brick pass for the bricks that voxels of `changed`, a box in the grid, have a part in. Earlier writes of
/// the image are waited for; the bricks are then readable by every shader stage. Loses the compute pipeline, the
/// descriptor sets of the compute bind point and the push constants.
void cmdBricks(VolumeImpl& volume, VkCommandBuffer commandBuffer, const VoxelBox& changed);

[[nodiscard]] inline bool isEmpty(const VoxelBox& box) {
    return box.size[0] == 0 || box.size[1] == 0 || box.size[2] == 0;
}

/// All voxels.
[[nodiscard]] inline VoxelBox wholeBox(const Grid& grid) {
    return {{}, grid.size};
}

} // namespace voxtact
