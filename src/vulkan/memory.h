// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <vulkan/vulkan_core.h>

#include <memory>
#include <span>
#include <utility>

namespace voxtact {

struct ContextImpl;

/// False once the context is given up: ContextImpl::giveUp().
[[nodiscard]] bool mayDestroy(const ContextImpl& context) noexcept;

/// One owned Vulkan object: destroyed with its context's device and allocator. Move-only.
template <class Handle> class Owned {
  public:
    using Destroy = void (*)(ContextImpl&, Handle);

    Owned() = default;
    Owned(ContextImpl& context, Handle handle, Destroy destroy) noexcept
        : context_(&context), handle_(handle), destroy_(destroy) {}
    Owned(Owned&& other) noexcept
        : context_(other.context_), handle_(std::exchange(other.handle_, Handle{})), destroy_(other.destroy_) {}
    Owned& operator=(Owned&& other) noexcept {
        if (this != &other) {
            reset();
            context_ = other.context_;
            handle_ = std::exchange(other.handle_, Handle{});
            destroy_ = other.destroy_;
        }
        return *this;
    }
    ~Owned() { reset(); }

    [[nodiscard]] Handle get() const noexcept { return handle_; }
    explicit operator bool() const noexcept { return handle_ != Handle{}; }
    void reset() noexcept {
        if (handle_ == Handle{}) {
            return;
        }
        const Handle ended = std::exchange(handle_, Handle{});
        if (mayDestroy(*context_)) {
            destroy_(*context_, ended);
        }
    }

  private:
    ContextImpl* context_ = nullptr;
    Handle handle_{};
    Destroy destroy_ = nullptr;
};

enum class MemoryUse {
    Device,   ///< device-local
    Upload,   ///< host-visible, written by the host in order, mapped
    ReadBack, ///< host-visible, cached where there is such memory, mapped
};

/// A buffer with its own allocation. voxtact makes few and large ones, so nothing is sub-allocated.
struct Buffer {
    Owned<VkDeviceMemory> memory;
    Owned<VkBuffer> buffer;
    VkDeviceSize size = 0;
    void* mapped = nullptr; ///< Upload and ReadBack
    bool coherent = true;

    [[nodiscard]] VkBuffer get() const noexcept { return buffer.get(); }
};

/// LimitExceeded where `size` is beyond the largest allocation; OutOfMemory where the device has no room.
[[nodiscard]] Result<Buffer> makeBuffer(ContextImpl& context, VkDeviceSize size, VkBufferUsageFlags usage,
                                        MemoryUse use, const char* name);
/// Makes a buffer on the device with `usage`, and beside it a mapped one for cmdFillBuffer() to fill it from.
[[nodiscard]] Result<void> makeStaged(ContextImpl& context, VkDeviceSize size, VkBufferUsageFlags usage,
                                      const char* name, Buffer& buffer, Buffer& staging);
/// Makes the host's writes to a mapped buffer visible to the device. Nothing to do on coherent memory.
[[nodiscard]] Result<void> flush(ContextImpl& context, const Buffer& buffer);
/// Makes the device's writes visible to the host.
[[nodiscard]] Result<void> invalidate(ContextImpl& context, const Buffer& buffer);

/// A small storage buffer, shared by the bindings of one context that have nothing to show: a set has no holes.
[[nodiscard]] Result<VkBuffer> emptyBuffer(ContextImpl& context);

struct Image {
    Owned<VkDeviceMemory> memory;
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
