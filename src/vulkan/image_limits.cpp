// SPDX-License-Identifier: MIT
#include "vulkan/image_limits.h"

#include "core/base/refuse.h"
#include "core/base/try.h"

#include <algorithm>

namespace voxtact {

Result<bool> isFiltered(const ContextImpl& context, VkFormat format, const std::string& what) {
    VkFormatProperties properties{};
    context.vk.GetPhysicalDeviceFormatProperties(context.physicalDevice, format, &properties);
    const VkFormatFeatureFlags features = properties.optimalTilingFeatures;
    if ((features & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT) == 0) {
        return Error{ErrorCode::Unsupported, 0,
                     what + ": the device has no sampled images of VkFormat " + std::to_string(format)};
    }
    return (features & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
}

Result<void> checkSides(const ContextImpl& context, const Grid& grid, const std::string& what) {
    constexpr const char* kAxes[] = {"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (grid.size[axis] > context.limits.maxImageDimension3D) {
            return Error{ErrorCode::LimitExceeded, 0,
                         what + " has " + std::to_string(grid.size[axis]) + " voxels along " + kAxes[axis] +
                             ", the device's maxImageDimension3D is " +
                             std::to_string(context.limits.maxImageDimension3D)};
        }
    }
    return {};
}

Result<void> checkSampledLayout(VkImageLayout layout, const char* what) {
    if (layout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL || layout == VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL ||
        layout == VK_IMAGE_LAYOUT_GENERAL) {
        return {};
    }
    return refuse(std::string(what) + " (VkImageLayout " + std::to_string(static_cast<std::int64_t>(layout)) +
                  ") is none in which an image of scalars can be sampled: SHADER_READ_ONLY_OPTIMAL, "
                  "READ_ONLY_OPTIMAL and GENERAL");
}

Result<void> checkImageLimits(ContextImpl& context, const Grid& grid, VkFormat format, VkImageUsageFlags usage,
                              std::size_t bytesOfVoxel, const std::string& what) {
    VOXTACT_TRY(checkSides(context, grid, what));
    VkImageFormatProperties properties{};
    const VkResult result = context.vk.GetPhysicalDeviceImageFormatProperties(
        context.physicalDevice, format, VK_IMAGE_TYPE_3D, VK_IMAGE_TILING_OPTIMAL, usage, 0, &properties);
    if (result != VK_SUCCESS) {
        return context.failure(result, "asking for the limits of a 3D image");
    }
    const VkDeviceSize bytes = voxelCount(grid) * bytesOfVoxel;
    const VkDeviceSize most = std::min(properties.maxResourceSize, context.maxAllocation);
    if (bytes > most) {
        return Error{ErrorCode::LimitExceeded, 0,
                     what + " has " + std::to_string(bytes) +
                         " bytes, the device's largest image (maxResourceSize, maxMemoryAllocationSize) has " +
                         std::to_string(most)};
    }
    return {};
}

} // namespace voxtact
