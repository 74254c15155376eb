// SPDX-License-Identifier: MIT
#pragma once

#include "view/frame/resources.h"

#include <array>

struct ImDrawData;

namespace voxtact::view {

/// Draws what Dear ImGui's panels made, by a pipeline of our own: dynamic rendering, no linked loader.
class Gui {
  public:
    /// Of the current ImGui context, whose font is uploaded: submits, and waits.
    [[nodiscard]] static Result<Gui> create(const device::Session& session, VkFormat format);

    /// A texture for ImGui::Image(); what it shows is set later. At most 8 of them.
    [[nodiscard]] Result<VkDescriptorSet> addTexture() { return drawing_.addTexture(); }
    /// No frame with it may be in flight.
    void setTexture(VkDescriptorSet texture, VkImageView view, VkImageLayout layout) const {
        drawing_.textures.set(texture, view, layout);
    }
    /// Inside a rendering of the window's image. `slot`: of the frame; its last use is done.
    [[nodiscard]] Result<void> record(VkCommandBuffer commands, const ImDrawData& data, std::uint32_t slot);

  private:
    explicit Gui(const device::VulkanDevice& device) : device_(&device) {}
    [[nodiscard]] Result<void> uploadFont(const device::Session& session);

    const device::VulkanDevice* device_;
    Drawing drawing_;
    Image font_;
    std::array<HostBuffer, kFramesInFlight> vertices_;
    std::array<HostBuffer, kFramesInFlight> indices_;
};

} // namespace voxtact::view
