// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/own/vulkan_device.h"

#include <cstring>
#include <span>
#include <vector>

namespace voxtact::test {

/// An embedder's own Vulkan code, with nothing of voxtact in it: command buffers, buffers and images made by hand on
/// a device of its own. Everything ends with this object. Failures throw.
class RawVulkan {
  public:
    explicit RawVulkan(const device::VulkanDevice& device);
    RawVulkan(const RawVulkan&) = delete;
    RawVulkan& operator=(const RawVulkan&) = delete;
    ~RawVulkan();

    [[nodiscard]] const VolkDeviceTable& vk() const { return device_.table(); }
    [[nodiscard]] VkDevice device() const { return device_.handle(); }

    struct HostBuffer {
        VkBuffer buffer = VK_NULL_HANDLE;
        void* mapped = nullptr;
    };
    /// Host-visible and coherent.
    HostBuffer makeBuffer(VkDeviceSize size, VkBufferUsageFlags usage);
    template <class Element> HostBuffer makeBuffer(std::span<const Element> data, VkBufferUsageFlags usage) {
        const HostBuffer out = makeBuffer(data.size_bytes(), usage);
        std::memcpy(out.mapped, data.data(), data.size_bytes());
        return out;
    }
    /// An image with its contents, left in `layout`, with `more` usage than for being sampled.
    VkImageView makeImage(VkImageType type, VkFormat format, VkExtent3D extent, std::span<const std::byte> texels,
                          VkImageLayout layout, VkImageUsageFlags more = 0);
    [[nodiscard]] VkImage lastImage() const { return images_.back(); }

    /// The contents of a buffer with usage TRANSFER_SRC that no command is using.
    std::vector<std::byte> readBuffer(VkBuffer buffer, VkDeviceSize size);
    /// The contents of a 3D image in layout SHADER_READ_ONLY_OPTIMAL, with usage TRANSFER_SRC, that no command is
    /// using.
    std::vector<std::byte> readImage(VkImage image, VkExtent3D extent, std::size_t texelBytes);

    VkCommandBuffer begin(VkCommandBufferUsageFlags flags = 0);
    /// Ends and submits; `fence` may be null.
    void submit(VkCommandBuffer commandBuffer, VkFence fence, bool end = true);
    VkFence makeFence();
    void wait(VkFence fence);
    void submitAndWait(VkCommandBuffer commandBuffer, bool end = true);

  private:
    VkDeviceMemory allocate(const VkMemoryRequirements& needs);

    device::VulkanDevice device_;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    std::vector<VkBuffer> buffers_;
    std::vector<VkImage> images_;
    std::vector<VkImageView> views_;
    std::vector<VkDeviceMemory> memories_;
    std::vector<VkFence> fences_;
};

} // namespace voxtact::test
