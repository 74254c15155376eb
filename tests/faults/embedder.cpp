// SPDX-License-Identifier: MIT
#include "embedder.h"

#include <cstring>

namespace voxtact::test {

namespace {

/// The embedder's calls go below the table: only a lost device fails them.
void must(VkResult result) {
    if (result != VK_SUCCESS) {
        throw PlayEnds("the embedder's own call failed: VkResult " + std::to_string(result));
    }
}

} // namespace

Embedder::Embedder(const Stage& stage) : vk_(stage.below), device_(stage.context.device), queue_(stage.queue.queue) {
    vk_.GetPhysicalDeviceMemoryProperties(stage.context.physicalDevice, &memoryTypes_);
    VkCommandPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    info.queueFamilyIndex = stage.queue.family;
    must(vk_.CreateCommandPool(device_, &info, nullptr, &pool_));
}

Embedder::~Embedder() {
    if (!fences_.empty()) {
        vk_.WaitForFences(device_, static_cast<std::uint32_t>(fences_.size()), fences_.data(), VK_TRUE, UINT64_MAX);
    }
    for (const VkImageView view : views_) {
        vk_.DestroyImageView(device_, view, nullptr);
    }
    for (const VkImage image : images_) {
        vk_.DestroyImage(device_, image, nullptr);
    }
    for (const VkBuffer buffer : buffers_) {
        vk_.DestroyBuffer(device_, buffer, nullptr);
    }
    for (const VkDeviceMemory memory : memories_) {
        vk_.FreeMemory(device_, memory, nullptr);
    }
    finished_.insert(finished_.end(), fences_.begin(), fences_.end());
    for (const VkFence fence : finished_) {
        vk_.DestroyFence(device_, fence, nullptr);
    }
    vk_.DestroyCommandPool(device_, pool_, nullptr);
}

VkCommandBuffer Embedder::begin() {
    VkCommandBufferAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    info.commandPool = pool_;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    must(vk_.AllocateCommandBuffers(device_, &info, &commands));
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    must(vk_.BeginCommandBuffer(commands, &begin));
    return commands;
}

void Embedder::submit(VkCommandBuffer commands) {
    must(vk_.EndCommandBuffer(commands));
    VkFenceCreateInfo fenceInfo{};
    fenceInfo.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fence = VK_NULL_HANDLE;
    must(vk_.CreateFence(device_, &fenceInfo, nullptr, &fence));
    VkCommandBufferSubmitInfo buffer{};
    buffer.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    buffer.commandBuffer = commands;
    VkSubmitInfo2 info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &buffer;
    const VkResult submitted = vk_.QueueSubmit2(queue_, 1, &info, fence);
    (submitted == VK_SUCCESS ? fences_ : finished_).push_back(fence);
    must(submitted);
}

void Embedder::wait() {
    if (!fences_.empty()) {
        must(vk_.WaitForFences(device_, static_cast<std::uint32_t>(fences_.size()), fences_.data(), VK_TRUE,
                               UINT64_MAX));
        finished_.insert(finished_.end(), fences_.begin(), fences_.end());
        fences_.clear();
    }
}

Embedder::Memory Embedder::allocate(const VkMemoryRequirements& needs, bool mapped) {
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs.size;
    for (std::uint32_t i = memoryTypes_.memoryTypeCount; i-- > 0;) {
        const VkMemoryPropertyFlags flags = memoryTypes_.memoryTypes[i].propertyFlags;
        if ((needs.memoryTypeBits & (1U << i)) != 0 &&
            (!mapped || (flags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0)) {
            info.memoryTypeIndex = i;
        }
    }
    Memory out;
    must(vk_.AllocateMemory(device_, &info, nullptr, &out.memory));
    memories_.push_back(out.memory);
    if (mapped) {
        must(vk_.MapMemory(device_, out.memory, 0, VK_WHOLE_SIZE, 0, &out.mapped));
    }
    return out;
}

void Embedder::flush(const Memory& memory, bool toDevice) {
    VkMappedMemoryRange range{};
    range.sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE;
    range.memory = memory.memory;
    range.size = VK_WHOLE_SIZE;
    must(toDevice ? vk_.FlushMappedMemoryRanges(device_, 1, &range)
                  : vk_.InvalidateMappedMemoryRanges(device_, 1, &range));
}

VkBuffer Embedder::makeBuffer(std::span<const std::byte> bytes, VkBufferUsageFlags usage) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes.size();
    info.usage = usage;
    VkBuffer buffer = VK_NULL_HANDLE;
    must(vk_.CreateBuffer(device_, &info, nullptr, &buffer));
    buffers_.push_back(buffer);
    VkMemoryRequirements needs{};
    vk_.GetBufferMemoryRequirements(device_, buffer, &needs);
    const Memory memory = allocate(needs, true);
    must(vk_.BindBufferMemory(device_, buffer, memory.memory, 0));
    std::memcpy(memory.mapped, bytes.data(), bytes.size());
    flush(memory, true);
    lastMapped_ = memory.mapped;
    return buffer;
}

void Embedder::change(VkCommandBuffer commands, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = images_.back();
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    vk_.CmdPipelineBarrier2(commands, &info);
}

VkImageView Embedder::makeImage(VkImageType type, VkFormat format, VkExtent3D extent,
                                std::span<const std::byte> texels) {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = type;
    info.format = format;
    info.extent = extent;
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = texels.empty() ? VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT
                                : VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    VkImage image = VK_NULL_HANDLE;
    must(vk_.CreateImage(device_, &info, nullptr, &image));
    images_.push_back(image);
    VkMemoryRequirements needs{};
    vk_.GetImageMemoryRequirements(device_, image, &needs);
    must(vk_.BindImageMemory(device_, image, allocate(needs, false).memory, 0));
    VkImageViewCreateInfo viewInfo{};
    viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    viewInfo.image = image;
    viewInfo.viewType = static_cast<VkImageViewType>(type); // they have the same numbers
    viewInfo.format = format;
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkImageView view = VK_NULL_HANDLE;
    must(vk_.CreateImageView(device_, &viewInfo, nullptr, &view));
    views_.push_back(view);

    const VkCommandBuffer commands = begin();
    if (texels.empty()) {
        change(commands, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    } else {
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = extent;
        change(commands, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        vk_.CmdCopyBufferToImage(commands, makeBuffer(texels, VK_BUFFER_USAGE_TRANSFER_SRC_BIT), image,
                                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        change(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
    submit(commands);
    wait();
    return view;
}

std::vector<std::byte> Embedder::readImage(VkExtent3D extent) {
    const std::vector<std::byte> nothing(std::size_t{4} * extent.width * extent.height);
    const VkBuffer buffer = makeBuffer(nothing, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const Memory memory{memories_.back(), nullptr};
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = extent;
    const VkCommandBuffer commands = begin();
    change(commands, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL);
    vk_.CmdCopyImageToBuffer(commands, images_.back(), VK_IMAGE_LAYOUT_GENERAL, buffer, 1, &region);
    submit(commands);
    wait();
    flush(memory, false);
    std::vector<std::byte> out(nothing.size());
    std::memcpy(out.data(), lastMapped_, out.size());
    return out;
}

} // namespace voxtact::test
