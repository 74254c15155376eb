// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/frame/resources.h"
#include "viewer/model/shown/pace.h"

#include <array>

struct ImDrawData;

namespace voxtact::view {

/// A texture that panels show.
struct ShownTexture {
    VkDescriptorSet panels = VK_NULL_HANDLE; ///< what they name
    VkDescriptorSet drawn = VK_NULL_HANDLE;
    SampledPart part;
};

/// Draws the output of Dear ImGui with its own pipeline: dynamic rendering, no linked loader.
class Gui {
  public:
    /// Uses the current ImGui context, whose font it uploads: submits, and waits.
    [[nodiscard]] static Result<Gui> create(const device::Session& session, VkFormat format);

    /// Creates a texture for ImGui::Image(); its image is set later. At most 8 textures.
    [[nodiscard]] Result<VkDescriptorSet> addTexture() { return drawing_.addTexture(); }
    /// No frame that uses it may be in flight.
    void setTexture(VkDescriptorSet texture, VkImageView view, VkImageLayout layout) const {
        drawing_.textures.set(texture, view, layout);
    }
    /// Call inside a rendering of the window's image. `slot`: of the frame; its last use is complete. `picture`: the
    /// picture of this frame, known only after the panels.
    [[nodiscard]] Result<void> record(VkCommandBuffer commands, const ImDrawData& data, std::uint32_t slot,
                                      const ShownTexture& picture);

  private:
    explicit Gui(const device::VulkanDevice& device) : device_(&device) {}
    [[nodiscard]] Result<void> uploadFont(const device::Session& session);
    void place(VkCommandBuffer commands, const ImDrawData& data, const SampledPart& part) const;

    const device::VulkanDevice* device_;
    Drawing drawing_;
    Image font_;
    std::array<HostBuffer, kFramesInFlight> vertices_;
    std::array<HostBuffer, kFramesInFlight> indices_;
};

} // namespace voxtact::view
