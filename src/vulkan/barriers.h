// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/context_impl.h"

namespace voxtact {

/// A global memory barrier.
inline void barrier(const ContextImpl& context, VkCommandBuffer commandBuffer, VkPipelineStageFlags2 fromStages,
                    VkAccessFlags2 fromAccess, VkPipelineStageFlags2 toStages, VkAccessFlags2 toAccess) {
    VkMemoryBarrier2 memory{};
    memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    memory.srcStageMask = fromStages;
    memory.srcAccessMask = fromAccess;
    memory.dstStageMask = toStages;
    memory.dstAccessMask = toAccess;
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &memory;
    context.vk.CmdPipelineBarrier2(commandBuffer, &info);
}

/// What an image memory barrier is from or to.
struct ImageUse {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

/// What uploads and edits leave.
inline constexpr ImageUse kReadByShaders{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

/// A barrier for a whole image of one mip level. From VK_IMAGE_LAYOUT_UNDEFINED the contents are lost.
void barrier(const ContextImpl& context, VkCommandBuffer commandBuffer, VkImage image, const ImageUse& from,
             const ImageUse& to, VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT);

/// Writes host data into a buffer, inline in the command buffer, in as many commands as it takes. `offset` and the
/// number of bytes are multiples of 4.
void cmdUpdateBuffer(const ContextImpl& context, VkCommandBuffer commandBuffer, VkBuffer buffer, VkDeviceSize offset,
                     std::span<const std::byte> data);

/// Copies a staging buffer over a whole buffer, whatever it held, and leaves it readable by every later command.
void cmdFillBuffer(const ContextImpl& context, VkCommandBuffer commandBuffer, const Buffer& staging,
                   const Buffer& buffer);

/// Copies a staging buffer over a whole image, whatever it held, and leaves it readable by every shader stage.
void cmdFillImage(const ContextImpl& context, VkCommandBuffer commandBuffer, VkBuffer staging, VkImage image,
                  VkExtent3D extent);

} // namespace voxtact
