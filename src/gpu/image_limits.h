// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/context_impl.h"
#include "voxtact/data.h"

namespace voxtact {

/// Refuses a 3D image of a voxel for each of the grid's that is beyond the device's limits (which limit, how large).
/// `what` begins the text ("the volume").
[[nodiscard]] Result<void> checkImageLimits(ContextImpl& context, const Grid& grid, VkFormat format,
                                            VkImageUsageFlags usage, std::size_t bytesOfVoxel, const std::string& what);

} // namespace voxtact
