// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/own/vulkan_device.h"

namespace voxtact::device {

/// All that one of Vulkan's lists holds: `list(count, elements)` is asked for their number, and then for them, again
/// where there are more by then. `what` begins the text of the error.
template <class Element, class List> Result<std::vector<Element>> enumerate(std::string_view what, List&& list) {
    std::vector<Element> all;
    std::uint32_t count = 0;
    VkResult result = VK_INCOMPLETE;
    while (result == VK_INCOMPLETE) {
        result = list(&count, nullptr);
        if (result == VK_SUCCESS) {
            all.resize(count);
            result = list(&count, all.data());
        }
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, what); // the number means nothing then
    }
    all.resize(count);
    return all;
}

} // namespace voxtact::device
