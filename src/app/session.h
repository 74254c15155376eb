// SPDX-License-Identifier: MIT
#pragma once

#include "app/outcome.h"
#include "app/shared_options.h"
#include "app/vulkan_device.h"
#include "voxtact/context.h"

#include <memory>

namespace voxtact::app {

/// voxtact on the device that the user chose. The context ends before the device, and that before the instance.
struct Session {
    VulkanInstance instance;
    VulkanDevice device;
    Context context;
};

[[nodiscard]] Result<Session> openSession(const DeviceChoice& choice);

/// Once everything made on the instance has ended: exit status 3 with the first message, if there was any.
[[nodiscard]] Outcome validationOutcome(const ValidationMessages& messages);

} // namespace voxtact::app
