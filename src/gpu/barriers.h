// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/context_impl.h"

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

/// Writes host data into a buffer, inline in the command buffer, in as many commands as it takes. `offset` and the
/// number of bytes are multiples of 4.
void cmdUpdateBuffer(const ContextImpl& context, VkCommandBuffer commandBuffer, VkBuffer buffer, VkDeviceSize offset,
                     std::span<const std::byte> data);

/// Copies a staging buffer over a whole image, whatever it held, and leaves it readable by every shader stage.
void cmdFillImage(const ContextImpl& context, VkCommandBuffer commandBuffer, VkBuffer staging, VkImage image,
                  VkExtent3D extent);

} // namespace voxtact
