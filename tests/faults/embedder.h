// SPDX-License-Identifier: MIT
#pragma once

#include "play.h"

#include <span>

namespace voxtact::test {

/// The caller's own Vulkan code on a stage: a command buffer, buffers and images, made below the table, where nothing
/// fails. Ends with this object, which waits for what it submitted.
class Embedder {
  public:
    explicit Embedder(const Stage& stage);
    Embedder(const Embedder&) = delete;
    Embedder& operator=(const Embedder&) = delete;
    ~Embedder();

    /// Begins a command buffer of its own.
    [[nodiscard]] VkCommandBuffer begin();
    void submit(VkCommandBuffer commands);
    /// Waits for all that was submitted.
    void wait();

    /// Holds `bytes`.
    [[nodiscard]] VkBuffer makeBuffer(std::span<const std::byte> bytes, VkBufferUsageFlags usage);
    template <class Element>
    [[nodiscard]] VkBuffer makeBuffer(std::span<const Element> data, VkBufferUsageFlags usage) {
        return makeBuffer(std::as_bytes(data), usage);
    }
    /// Holds `texels`, in SHADER_READ_ONLY_OPTIMAL; without any it is to be rendered to, in GENERAL.
    [[nodiscard]] VkImageView makeImage(VkImageType type, VkFormat format, VkExtent3D extent,
                                        std::span<const std::byte> texels);
    /// What is in the image that was made last, 2D of four bytes a texel.
    [[nodiscard]] std::vector<std::byte> readImage(VkExtent3D extent);

  private:
    struct Memory {
        VkDeviceMemory memory = VK_NULL_HANDLE;
        void* mapped = nullptr;
    };
    [[nodiscard]] Memory allocate(const VkMemoryRequirements& needs, bool mapped);
    void flush(const Memory& memory, bool toDevice);
    void change(VkCommandBuffer commands, VkImageLayout from, VkImageLayout to);

    const DeviceFunctions& vk_;
    VkDevice device_;
    VkQueue queue_;
    VkPhysicalDeviceMemoryProperties memoryTypes_{};
    VkCommandPool pool_ = VK_NULL_HANDLE;
    std::vector<VkFence> fences_;   ///< of submissions that are not waited for
    std::vector<VkFence> finished_; ///< of those that are
    std::vector<VkBuffer> buffers_;
    std::vector<VkImage> images_;
    std::vector<VkImageView> views_;
    std::vector<VkDeviceMemory> memories_;
    void* lastMapped_ = nullptr; ///< of the buffer that was made last
};

} // namespace voxtact::test
