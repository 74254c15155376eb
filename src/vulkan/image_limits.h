// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "vulkan/context_impl.h"

namespace voxtact {

/// Refuses a grid with more voxels along an axis than an image of the device has.
[[nodiscard]] Result<void> checkSides(const ContextImpl& context, const Grid& grid, const std::string& what);
/// Whether shaders can filter images of the format linearly. Refuses a format that they cannot read at all. `what`
/// begins the text ("the volume").
[[nodiscard]] Result<bool> isFiltered(const ContextImpl& context, VkFormat format, const std::string& what);
/// Refuses a layout in which no shader can sample a colour image.
[[nodiscard]] Result<void> checkSampledLayout(VkImageLayout layout, const char* what);
/// Refuses a 3D image of a voxel for each of the grid's that is beyond the device's limits (which limit, how large).
/// `what` begins the text ("the volume").
[[nodiscard]] Result<void> checkImageLimits(ContextImpl& context, const Grid& grid, VkFormat format,
                                            VkImageUsageFlags usage, std::size_t bytesOfVoxel, const std::string& what);

} // namespace voxtact
