// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/context.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voxtact {

[[nodiscard]] std::vector<VkQueueFamilyProperties>
queueFamiliesOf(VkPhysicalDevice device, PFN_vkGetPhysicalDeviceQueueFamilyProperties getProperties);

/// Refuses a queue family that is not among a device's, or that has none of `anyOf`. `what` begins the text.
[[nodiscard]] Result<void> checkFamily(std::span<const VkQueueFamilyProperties> all, std::uint32_t family,
                                       VkQueueFlags anyOf, const char* what);

/// Those of ContextDesc::queueFamilies: each there is, and each once. What cannot be asked, without a handle, is not
/// refused.
[[nodiscard]] Result<void> checkFamilies(const ContextDesc& desc);

} // namespace voxtact
