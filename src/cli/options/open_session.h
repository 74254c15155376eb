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

/// Opens the device of the options. Prints the context's warnings as notes.
[[nodiscard]] Result<device::Session> openSession(const DeviceChoice& choice, const SessionExtensions& extensions = {});
/// Returns the user's location of a device's pipeline cache.
[[nodiscard]] device::PipelineStore pipelineStore(const DeviceChoice& choice, const device::PhysicalDevice& device);

/// Call after all objects of the instance are destroyed. Returns exit status 3 with the first message, if any.
[[nodiscard]] Outcome validationOutcome(const device::ValidationMessages& messages);

} // namespace voxtact::app
