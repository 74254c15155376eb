// SPDX-License-Identifier: MIT
#pragma once

#include "app/cache_folder.h"
#include "app/outcome.h"
#include "app/pipeline_cache.h"
#include "app/shared_options.h"
#include "device/vulkan_device.h"
#include "voxtact/context.h"

#include <memory>

namespace voxtact::app {

/// voxtact on a device. The context ends before its pipeline cache, that before the device, and that before the
/// instance.
struct Session {
    VulkanInstance instance;
    VulkanDevice device;
    CacheFolder cache;
    PipelineCache pipelines;
    Context context;
};

/// On the device that the user chose. The context's warnings are printed as notes.
[[nodiscard]] Result<Session> openSession(const DeviceChoice& choice);
/// On this device; `log` may be null.
[[nodiscard]] Result<Session> openSessionOn(const VulkanInstance& instance, const PhysicalDevice& physical,
                                            const DeviceChoice& choice, LogCallback log);

/// Once everything made on the instance has ended: exit status 3 with the first message, if there was any.
[[nodiscard]] Outcome validationOutcome(const ValidationMessages& messages);

} // namespace voxtact::app
