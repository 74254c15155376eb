// SPDX-License-Identifier: MIT
#pragma once

#include "device/pipeline_cache.h"
#include "device/vulkan_device.h"
#include "voxtact/context.h"

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
