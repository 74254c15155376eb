// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/own/session.h"

#include <cstdint>
#include <functional>
#include <span>

/// The window's own Vulkan objects, in addition to voxtact's, like those of an embedding engine.
namespace voxtact::view {

/// Number of frames in flight.
inline constexpr std::uint32_t kFramesInFlight = 2;

/// An image in device memory with a view of all of it; colour, one mip level.
class Image {
  public:
    Image() = default;
    [[nodiscard]] static Result<Image> create(const device::VulkanDevice& device, VkExtent2D extent, VkFormat format,
                                              VkImageUsageFlags usage);
    Image(Image&& other) noexcept { *this = std::move(other); }
    Image& operator=(Image&& other) noexcept;
    ~Image();

    [[nodiscard]] VkImage handle() const noexcept { return image_; }
    [[nodiscard]] VkImageView view() const noexcept { return view_; }
    [[nodiscard]] VkExtent2D extent() const noexcept { return extent_; }

  private:
    const device::VulkanDevice* device_ = nullptr;
    VkImage image_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkExtent2D extent_{};
};

/// A buffer that the host writes: mapped and coherent.
class HostBuffer {
  public:
    HostBuffer() = default;
    [[nodiscard]] static Result<HostBuffer> create(const device::VulkanDevice& device, VkDeviceSize bytes,
                                                   VkBufferUsageFlags usage);
    HostBuffer(HostBuffer&& other) noexcept { *this = std::move(other); }
    HostBuffer& operator=(HostBuffer&& other) noexcept;
    ~HostBuffer();

    [[nodiscard]] VkBuffer handle() const noexcept { return buffer_; }
    [[nodiscard]] std::span<std::byte> bytes() const noexcept { return bytes_; }

  private:
    const device::VulkanDevice* device_ = nullptr;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    std::span<std::byte> bytes_;
};

/// Pipeline of the panels and slices: one texture, some bytes of push constants, any viewport.
struct DrawPipelineDesc {
    std::span<const std::uint32_t> vertexShader;
    std::span<const std::uint32_t> fragmentShader;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkShaderStageFlags pushStages = 0;
    std::uint32_t pushBytes = 0;
    bool blended = false;
    bool guiVertices = false; ///< position, coordinate and colour as Dear ImGui has them; without: no vertices
};

/// A pipeline with its layouts, for dynamic rendering.
class DrawPipeline {
  public:
    DrawPipeline() = default;
    [[nodiscard]] static Result<DrawPipeline> create(const device::VulkanDevice& device, const DrawPipelineDesc& desc);
    DrawPipeline(DrawPipeline&& other) noexcept { *this = std::move(other); }
    DrawPipeline& operator=(DrawPipeline&& other) noexcept;
    ~DrawPipeline();

    [[nodiscard]] VkPipeline handle() const noexcept { return pipeline_; }
    [[nodiscard]] VkPipelineLayout layout() const noexcept { return layout_; }
    [[nodiscard]] VkDescriptorSetLayout setLayout() const noexcept { return setLayout_; }

  private:
    const device::VulkanDevice* device_ = nullptr;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

/// A sampler, and descriptor sets of one texture each.
class Textures {
  public:
    Textures() = default;
    [[nodiscard]] static Result<Textures> create(const device::VulkanDevice& device, std::uint32_t most,
                                                 VkFilter filter);
    Textures(Textures&& other) noexcept { *this = std::move(other); }
    Textures& operator=(Textures&& other) noexcept;
    ~Textures();

    [[nodiscard]] Result<VkDescriptorSet> add(VkDescriptorSetLayout layout);
    /// No submission with the set may be in flight.
    void set(VkDescriptorSet set, VkImageView view, VkImageLayout layout) const;

  private:
    const device::VulkanDevice* device_ = nullptr;
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
};

/// Pipeline and descriptor sets.
struct Drawing {
    [[nodiscard]] static Result<Drawing> create(const device::VulkanDevice& device, const DrawPipelineDesc& desc,
                                                std::uint32_t mostTextures, VkFilter filter);
    [[nodiscard]] Result<VkDescriptorSet> addTexture() { return textures.add(pipeline.setLayout()); }

    DrawPipeline pipeline;
    Textures textures;
};

/// One side of a memory barrier: stages and accesses.
struct BarrierSide {
    VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
};
void memoryBarrier(const device::VulkanDevice& device, VkCommandBuffer commands, const BarrierSide& before,
                   const BarrierSide& after);
struct LayoutChange {
    VkImage image = VK_NULL_HANDLE;
    VkImageLayout from = VK_IMAGE_LAYOUT_UNDEFINED;
    VkImageLayout to = VK_IMAGE_LAYOUT_UNDEFINED;
};
void layoutBarrier(const device::VulkanDevice& device, VkCommandBuffer commands, const LayoutChange& change,
                   const BarrierSide& before, const BarrierSide& after);

/// Records with `record`, submits to the session's queue, and waits.
[[nodiscard]] Result<void> submitAndWait(const device::Session& session,
                                         const std::function<void(VkCommandBuffer)>& record);

/// One colour target, its whole area.
void beginRendering(const device::VulkanDevice& device, VkCommandBuffer commands, VkImageView view,
                    VkImageLayout layout, VkExtent2D extent);

} // namespace voxtact::view
