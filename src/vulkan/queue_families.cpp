// SPDX-License-Identifier: MIT
#include "vulkan/queue_families.h"

#include "core/base/refuse.h"
#include "core/base/try.h"

#include <algorithm>
#include <cstddef>
#include <string>

namespace voxtact {

std::vector<VkQueueFamilyProperties> queueFamiliesOf(VkPhysicalDevice device,
                                                     PFN_vkGetPhysicalDeviceQueueFamilyProperties getProperties) {
    std::uint32_t count = 0;
    getProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> out(count);
    getProperties(device, &count, out.data());
    return out;
}

Result<void> checkFamily(std::span<const VkQueueFamilyProperties> all, std::uint32_t family, VkQueueFlags anyOf,
                         const char* what) {
    if (family >= all.size()) {
        return refuse(std::string(what) + " is " + std::to_string(family) + ", the device has " +
                      std::to_string(all.size()) + " queue families");
    }
    if ((all[family].queueFlags & anyOf) == 0) {
        return refuse(std::string(what) + " is " + std::to_string(family) + ", a family of queues that " +
                      (anyOf == VK_QUEUE_GRAPHICS_BIT  ? "cannot draw"
                       : anyOf == VK_QUEUE_COMPUTE_BIT ? "cannot compute"
                                                       : "can neither draw nor compute"));
    }
    return {};
}

Result<void> checkFamilies(const ContextDesc& desc) {
    const std::span<const std::uint32_t> families = desc.queueFamilies;
    if (families.empty() || desc.getInstanceProcAddr == nullptr || desc.instance == VK_NULL_HANDLE ||
        desc.physicalDevice == VK_NULL_HANDLE) {
        return {};
    }
    const auto getProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(
        desc.getInstanceProcAddr(desc.instance, "vkGetPhysicalDeviceQueueFamilyProperties"));
    if (getProperties == nullptr) {
        return {};
    }
    const std::vector<VkQueueFamilyProperties> all = queueFamiliesOf(desc.physicalDevice, getProperties);
    for (std::size_t i = 0; i < families.size(); ++i) {
        constexpr VkQueueFlags kAny = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT;
        const std::string which = "ContextDesc::queueFamilies[" + std::to_string(i) + "]";
        VOXTACT_TRY(checkFamily(all, families[i], kAny, which.c_str()));
        if (std::ranges::find(families.first(i), families[i]) != families.begin() + static_cast<std::ptrdiff_t>(i)) {
            return refuse(which + " is " + std::to_string(families[i]) + ", which is there before");
        }
    }
    return {};
}

} // namespace voxtact
