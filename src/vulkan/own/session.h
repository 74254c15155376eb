// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/context.h"
#include "vulkan/own/pipeline_cache.h"
#include "vulkan/own/vulkan_device.h"

namespace voxtact::device {

/// voxtact on a device. The context ends before its pipeline cache, that before the device, and that before the
/// instance.
struct Session {
    VulkanInstance instance;
    VulkanDevice device;
    PipelineCache pipelines;
    Context context;
};

/// `log` may be null.
[[nodiscard]] Result<Session> openSessionOn(const VulkanInstance& instance, const PhysicalDevice& physical,
                                            PipelineStore store, LogCallback log, const DeviceOptions& options = {});

} // namespace voxtact::device
