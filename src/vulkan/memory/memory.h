// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"
#include "vulkan/memory/pool.h"

#include <vulkan/vulkan_core.h>

#include <span>
#include <utility>

namespace voxtact {

/// Ends before its memory, also when another is moved into it.
struct Buffer {
    Buffer() = default;
    Buffer(Buffer&&) noexcept = default;
    Buffer& operator=(Buffer&& other) noexcept {
        buffer = std::move(other.buffer);
        memory = std::move(other.memory);
        size = other.size;
        mapped = other.mapped;
        return *this;
    }
    ~Buffer() = default;

    Memory memory;
    Owned<VkBuffer> buffer;
    VkDeviceSize size = 0;
    void* mapped = nullptr; ///< Upload and ReadBack

    [[nodiscard]] VkBuffer get() const noexcept { return buffer.get(); }
};

/// LimitExceeded where `size` is beyond the largest allocation; OutOfMemory where the device has no room.
[[nodiscard]] Result<Buffer> makeBuffer(ContextImpl& context, VkDeviceSize size, VkBufferUsageFlags usage,
                                        MemoryUse use, const char* name);
/// Makes a buffer on the device with `usage`, and a mapped one for cmdFillBuffer() to fill it from.
[[nodiscard]] Result<void> makeStaged(ContextImpl& context, VkDeviceSize size, VkBufferUsageFlags usage,
                                      const char* name, Buffer& buffer, Buffer& staging);
/// Makes the host's writes to a mapped buffer visible to the device. Nothing to do on coherent memory.
[[nodiscard]] Result<void> flush(ContextImpl& context, const Buffer& buffer);
/// Makes the device's writes visible to the host.
[[nodiscard]] Result<void> invalidate(ContextImpl& context, const Buffer& buffer);

/// A small storage buffer, shared by the bindings of one context that have nothing to show: a set has no holes.
[[nodiscard]] Result<VkBuffer> emptyBuffer(ContextImpl& context);

/// Ends before its memory, also when another is moved into it.
struct Image {
    Image() = default;
    Image(Image&&) noexcept = default;
    Image& operator=(Image&& other) noexcept {
        view = std::move(other.view);
        image = std::move(other.image);
        memory = std::move(other.memory);
        return *this;
    }
    ~Image() = default;

    Memory memory;
    Owned<VkImage> image;
    Owned<VkImageView> view;
};

struct ImageDesc {
    VkImageType type = VK_IMAGE_TYPE_3D;
    VkImageViewType viewType = VK_IMAGE_VIEW_TYPE_3D;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent3D extent{1, 1, 1};
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

/// `what` begins the error text ("the volume").
[[nodiscard]] Result<Image> makeImage(ContextImpl& context, const ImageDesc& desc, const char* what, const char* name);

/// A descriptor set in a pool of its own.
struct DescriptorSet {
    Owned<VkDescriptorPool> pool;
    VkDescriptorSet set = VK_NULL_HANDLE;
};

[[nodiscard]] Result<DescriptorSet> makeDescriptorSet(ContextImpl& context, VkDescriptorSetLayout layout,
                                                      std::span<const VkDescriptorPoolSize> sizes, const char* name);
/// Writes an image; a combined image sampler has `sampler`, or the context's linear one where it is null.
void writeImage(ContextImpl& context, VkDescriptorSet set, std::uint32_t binding, VkDescriptorType type,
                VkImageView view, VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                VkSampler sampler = VK_NULL_HANDLE);
/// Writes a storage buffer, from `offset` on.
void writeBuffer(ContextImpl& context, VkDescriptorSet set, std::uint32_t binding, VkBuffer buffer,
                 VkDeviceSize range = VK_WHOLE_SIZE, VkDeviceSize offset = 0);

} // namespace voxtact
