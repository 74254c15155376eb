// SPDX-License-Identifier: MIT
#pragma once

#include "raw_vulkan.h"
#include "voxtact/render.h"

namespace voxtact::test {

/// An embedder's own image, in layout GENERAL, and the embedder's Vulkan code beside it.
class OwnImage {
  public:
    OwnImage(const device::VulkanDevice& device, VkExtent2D extent);

    [[nodiscard]] std::size_t bytes() const { return std::size_t{4} * extent_.width * extent_.height; }
    [[nodiscard]] Target target(RenderTargets& targets) const;
    /// Copies what was rendered, and lets the image be rendered to again.
    [[nodiscard]] const std::uint8_t* cmdCopy(VkCommandBuffer commands);

    RawVulkan raw;

  private:
    struct Use {
        VkPipelineStageFlags2 stages;
        VkAccessFlags2 access;
        VkImageLayout layout;
    };
    void change(VkCommandBuffer commands, const Use& from, const Use& to);

    VkExtent2D extent_;
    VkImageView view_;
    VkImage image_;
};

} // namespace voxtact::test
