// SPDX-License-Identifier: MIT
#include "raw_vulkan.h"

#include <cstring>
#include <stdexcept>
#include <utility>

namespace voxtact::test {

namespace {

void must(VkResult result) {
    if (result != VK_SUCCESS) {
        throw std::runtime_error("VkResult " + std::to_string(result));
    }
}

} // namespace

RawVulkan::RawVulkan(const device::VulkanDevice& device) : device_(device), queue_(device.queueAccess().queue) {
    VkCommandPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    info.queueFamilyIndex = device.queueAccess().family;
    must(vk().vkCreateCommandPool(this->device(), &info, nullptr, &pool_));
}

RawVulkan::~RawVulkan() {
    vk().vkDeviceWaitIdle(device());
    for (const VkImageView view : views_) {
        vk().vkDestroyImageView(device(), view, nullptr);
    }
    for (const VkImage image : images_) {
        vk().vkDestroyImage(device(), image, nullptr);
    }
    for (const VkBuffer buffer : buffers_) {
        vk().vkDestroyBuffer(device(), buffer, nullptr);
    }
    for (const VkDeviceMemory memory : memories_) {
        vk().vkFreeMemory(device(), memory, nullptr);
    }
    for (const VkFence fence : fences_) {
        vk().vkDestroyFence(device(), fence, nullptr);
    }
    vk().vkDestroyCommandPool(device(), pool_, nullptr);
}

VkDeviceMemory RawVulkan::allocate(const VkMemoryRequirements& needs) {
    const ContextDesc& desc = device_.contextDesc();
    const auto getProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties>(
        desc.getInstanceProcAddr(desc.instance, "vkGetPhysicalDeviceMemoryProperties"));
    VkPhysicalDeviceMemoryProperties properties{};
    getProperties(desc.physicalDevice, &properties);
    constexpr VkMemoryPropertyFlags kWanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs.size;
    // Host-visible where the object allows it, which buffers always do.
    for (std::uint32_t i = properties.memoryTypeCount; i-- > 0;) {
        const bool allowed = (needs.memoryTypeBits & (1U << i)) != 0;
        const bool wanted = (properties.memoryTypes[i].propertyFlags & kWanted) == kWanted;
        if (allowed) {
            info.memoryTypeIndex = i;
        }
        if (allowed && wanted) {
            break;
        }
    }
    VkDeviceMemory memory = VK_NULL_HANDLE;
    must(vk().vkAllocateMemory(device(), &info, nullptr, &memory));
    memories_.push_back(memory);
    return memory;
}

RawVulkan::HostBuffer RawVulkan::makeBuffer(VkDeviceSize size, VkBufferUsageFlags usage) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = size;
    info.usage = usage;
    HostBuffer out;
    must(vk().vkCreateBuffer(device(), &info, nullptr, &out.buffer));
    buffers_.push_back(out.buffer);
    VkMemoryRequirements needs{};
    vk().vkGetBufferMemoryRequirements(device(), out.buffer, &needs);
    const VkDeviceMemory memory = allocate(needs);
    must(vk().vkBindBufferMemory(device(), out.buffer, memory, 0));
    must(vk().vkMapMemory(device(), memory, 0, VK_WHOLE_SIZE, 0, &out.mapped));
    return out;
}

VkImageView RawVulkan::makeImage(VkImageType type, VkFormat format, VkExtent3D extent,
                                 std::span<const std::byte> texels, VkImageLayout layout, VkImageUsageFlags more) {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = type;
    info.format = format;
    info.extent = extent;
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | more;
    VkImage image = VK_NULL_HANDLE;
    must(vk().vkCreateImage(device(), &info, nullptr, &image));
    images_.push_back(image);
    VkMemoryRequirements needs{};
    vk().vkGetImageMemoryRequirements(device(), image, &needs);
    must(vk().vkBindImageMemory(device(), image, allocate(needs), 0));

    const HostBuffer staging = makeBuffer(texels, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const VkCommandBuffer commands = begin();
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vk().vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0,
                              nullptr, 0, nullptr, 1, &barrier);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = extent;
    vk().vkCmdCopyBufferToImage(commands, staging.buffer, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = layout;
    vk().vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0,
                              nullptr, 0, nullptr, 1, &barrier);
    submitAndWait(commands);

    VkImageViewCreateInfo viewInfo{};
    viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    viewInfo.image = image;
    viewInfo.viewType = type == VK_IMAGE_TYPE_3D   ? VK_IMAGE_VIEW_TYPE_3D
                        : type == VK_IMAGE_TYPE_2D ? VK_IMAGE_VIEW_TYPE_2D
                                                   : VK_IMAGE_VIEW_TYPE_1D;
    viewInfo.format = format;
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkImageView view = VK_NULL_HANDLE;
    must(vk().vkCreateImageView(device(), &viewInfo, nullptr, &view));
    views_.push_back(view);
    return view;
}

std::vector<std::byte> RawVulkan::readBuffer(VkBuffer buffer, VkDeviceSize size) {
    const HostBuffer mine = makeBuffer(size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkCommandBuffer commands = begin();
    const VkBufferCopy whole{0, 0, size};
    vk().vkCmdCopyBuffer(commands, buffer, mine.buffer, 1, &whole);
    submitAndWait(commands);
    const auto* first = static_cast<const std::byte*>(mine.mapped);
    return {first, first + size};
}

std::vector<std::byte> RawVulkan::readImage(VkImage image, VkExtent3D extent, std::size_t texelBytes) {
    const VkDeviceSize size = VkDeviceSize{extent.width} * extent.height * extent.depth * texelBytes;
    const HostBuffer mine = makeBuffer(size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkCommandBuffer commands = begin();
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vk().vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0,
                              nullptr, 0, nullptr, 1, &barrier);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = extent;
    vk().vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, mine.buffer, 1, &region);
    barrier.srcAccessMask = 0;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    std::swap(barrier.oldLayout, barrier.newLayout);
    vk().vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                              nullptr, 0, nullptr, 1, &barrier);
    submitAndWait(commands);
    const auto* first = static_cast<const std::byte*>(mine.mapped);
    return {first, first + size};
}

VkCommandBuffer RawVulkan::begin(VkCommandBufferUsageFlags flags) {
    VkCommandBufferAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    info.commandPool = pool_;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    must(vk().vkAllocateCommandBuffers(device(), &info, &commands));
    VkCommandBufferBeginInfo beginInfo{};
    beginInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    beginInfo.flags = flags;
    must(vk().vkBeginCommandBuffer(commands, &beginInfo));
    return commands;
}

void RawVulkan::submit(VkCommandBuffer commandBuffer, VkFence fence, bool end) {
    if (end) {
        must(vk().vkEndCommandBuffer(commandBuffer));
    }
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commandBuffer;
    must(vk().vkQueueSubmit(queue_, 1, &info, fence));
}

VkFence RawVulkan::makeFence() {
    VkFenceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fence = VK_NULL_HANDLE;
    must(vk().vkCreateFence(device(), &info, nullptr, &fence));
    fences_.push_back(fence);
    return fence;
}

void RawVulkan::wait(VkFence fence) {
    must(vk().vkWaitForFences(device(), 1, &fence, VK_TRUE, UINT64_MAX));
}

void RawVulkan::submitAndWait(VkCommandBuffer commandBuffer, bool end) {
    const VkFence fence = makeFence();
    submit(commandBuffer, fence, end);
    wait(fence);
}

} // namespace voxtact::test
