// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/own/vulkan_device.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace voxtact::device {

/// Where a pipeline cache is kept from run to run. Both empty: nowhere.
struct PipelineStore {
    std::function<std::optional<std::string>()> read;
    std::function<void(std::string_view blob)> write;
};

/// A VkPipelineCache that begins with what the last run left in its store, and leaves what it has grown to. Must end
/// before the device, and after what was made with it.
class PipelineCache {
  public:
    /// Null without a store, or when the driver refuses: everything works without.
    PipelineCache(const VulkanDevice& device, PipelineStore store);
    PipelineCache(PipelineCache&& other) noexcept;
    PipelineCache& operator=(PipelineCache&&) = delete;
    ~PipelineCache();

    [[nodiscard]] VkPipelineCache handle() const noexcept { return handle_; }

  private:
    void save() const;

    VulkanDevice device_;
    PipelineStore store_;
    std::size_t bytes_ = 0; ///< more than these are worth saving
    VkPipelineCache handle_ = VK_NULL_HANDLE;
};

/// Whether a blob begins with the header (version one) that this device's driver writes.
[[nodiscard]] bool pipelineBlobFits(std::string_view blob, const PhysicalDevice& device);

} // namespace voxtact::device
