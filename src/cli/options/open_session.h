// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/cache_folder.h"
#include "cli/options/shared_options.h"
#include "vulkan/own/session.h"

namespace voxtact::app {

/// Additional extensions of instance and device for a window.
struct SessionExtensions {
    std::vector<const char*> instance{};
    std::vector<const char*> device{};
};

/// On the device that the user chose. The context's warnings are printed as notes.
[[nodiscard]] Result<device::Session> openSession(const DeviceChoice& choice, const SessionExtensions& extensions = {});
/// Returns the user's location of a device's pipeline cache.
[[nodiscard]] device::PipelineStore pipelineStore(const DeviceChoice& choice, const device::PhysicalDevice& device);

/// Once everything made on the instance has ended: exit status 3 with the first message, if there was any.
[[nodiscard]] Outcome validationOutcome(const device::ValidationMessages& messages);

} // namespace voxtact::app
