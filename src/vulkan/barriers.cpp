// SPDX-License-Identifier: MIT
#include "vulkan/barriers.h"

#include <algorithm>

namespace voxtact {

void cmdUpdateBuffer(const ContextImpl& context, VkCommandBuffer commandBuffer, VkBuffer buffer, VkDeviceSize offset,
                     std::span<const std::byte> data) {
    constexpr std::size_t kMost = 65536; // of one vkCmdUpdateBuffer
    for (std::size_t done = 0; done < data.size(); done += kMost) {
        const std::span<const std::byte> part = data.subspan(done, std::min(kMost, data.size() - done));
        context.vk.CmdUpdateBuffer(commandBuffer, buffer, offset + done, part.size(), part.data());
    }
}

void barrier(const ContextImpl& context, VkCommandBuffer commandBuffer, VkImage image, const ImageUse& from,
             const ImageUse& to, VkImageAspectFlags aspect) {
    VkImageMemoryBarrier2 transition{};
    transition.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    transition.srcStageMask = from.stages;
    transition.srcAccessMask = from.access;
    transition.dstStageMask = to.stages;
    transition.dstAccessMask = to.access;
    transition.oldLayout = from.layout;
    transition.newLayout = to.layout;
    transition.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    transition.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    transition.image = image;
    transition.subresourceRange = {aspect, 0, 1, 0, 1};
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &transition;
    context.vk.CmdPipelineBarrier2(commandBuffer, &info);
}

void cmdFillBuffer(const ContextImpl& context, VkCommandBuffer commandBuffer, const Buffer& staging,
                   const Buffer& buffer) {
    // Earlier readers must be done before the contents go.
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_PIPELINE_STAGE_2_COPY_BIT,
            VK_ACCESS_2_TRANSFER_WRITE_BIT);
    const VkBufferCopy whole{0, 0, buffer.size};
    context.vk.CmdCopyBuffer(commandBuffer, staging.get(), buffer.get(), 1, &whole);
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT);
}

void cmdFillImage(const ContextImpl& context, VkCommandBuffer commandBuffer, VkBuffer staging, VkImage image,
                  VkExtent3D extent) {
    constexpr ImageUse kCopied{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
    // Earlier readers must be done before the contents go.
    barrier(context, commandBuffer, image, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED},
            kCopied);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = extent;
    context.vk.CmdCopyBufferToImage(commandBuffer, staging, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    barrier(context, commandBuffer, image, kCopied, kReadByShaders);
}

} // namespace voxtact
