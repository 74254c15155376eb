// SPDX-License-Identifier: MIT
#pragma once

#include "app/cache_folder.h"
#include "device/vulkan_device.h"

#include <cstddef>
#include <string>

namespace voxtact::app {

/// A VkPipelineCache that begins with what the last run left in the cache folder, and leaves what it has grown to.
/// Must end before the device, and after what was made with it.
class PipelineCache {
  public:
    /// Null when the cache is off or the driver refuses: everything works without.
    PipelineCache(const VulkanDevice& device, const CacheFolder& folder);
    PipelineCache(PipelineCache&& other) noexcept;
    PipelineCache& operator=(PipelineCache&&) = delete;
    ~PipelineCache();

    [[nodiscard]] VkPipelineCache handle() const noexcept { return handle_; }

  private:
    void save() const;

    VulkanDevice device_;
    CacheFolder folder_;
    std::string name_;
    std::size_t bytes_ = 0; ///< more than these are worth saving
    VkPipelineCache handle_ = VK_NULL_HANDLE;
};

/// Whether a blob begins with the header (version one) that this device's driver writes.
[[nodiscard]] bool pipelineBlobFits(std::string_view blob, const PhysicalDevice& device);

} // namespace voxtact::app
