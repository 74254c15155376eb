// SPDX-License-Identifier: MIT
#include "own_image.h"

namespace voxtact::test {

OwnImage::OwnImage(const device::VulkanDevice& device, VkExtent2D extent)
    : raw(device), extent_(extent),
      view_(raw.makeImage(VK_IMAGE_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, {extent.width, extent.height, 1},
                          std::vector<std::byte>(bytes()), VK_IMAGE_LAYOUT_GENERAL,
                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT)),
      image_(raw.lastImage()) {}

Target OwnImage::target(RenderTargets& targets) const {
    Target out;
    out.view = view_;
    out.extent = extent_;
    out.layout = VK_IMAGE_LAYOUT_GENERAL;
    out.targets = &targets;
    return out;
}

const std::uint8_t* OwnImage::cmdCopy(VkCommandBuffer commands) {
    const RawVulkan::HostBuffer out = raw.makeBuffer(bytes(), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    constexpr Use kRendered{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                            VK_IMAGE_LAYOUT_GENERAL};
    constexpr Use kCopied{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                          VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    change(commands, kRendered, kCopied);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {extent_.width, extent_.height, 1};
    raw.vk().vkCmdCopyImageToBuffer(commands, image_, kCopied.layout, out.buffer, 1, &region);
    change(commands, kCopied, kRendered);
    return static_cast<const std::uint8_t*>(out.mapped);
}

void OwnImage::change(VkCommandBuffer commands, const Use& from, const Use& to) {
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = from.stages;
    barrier.srcAccessMask = from.access;
    barrier.dstStageMask = to.stages;
    barrier.dstAccessMask = to.access;
    barrier.oldLayout = from.layout;
    barrier.newLayout = to.layout;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image_;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    raw.vk().vkCmdPipelineBarrier2(commands, &info);
}

} // namespace voxtact::test
