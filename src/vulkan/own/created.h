// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan_core.h>

namespace voxtact::device {

/// Passes the result of a create on. What a failed one leaves in its handle is nothing to destroy.
template <class Handle> VkResult createdOrNull(VkResult result, Handle& handle) noexcept {
    if (result != VK_SUCCESS) {
        handle = VK_NULL_HANDLE;
    }
    return result;
}

} // namespace voxtact::device
