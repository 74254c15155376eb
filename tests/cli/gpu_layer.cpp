// SPDX-License-Identifier: MIT
// A Vulkan layer that calls every device a discrete GPU, so that a machine without one can be asked what the program
// would do there.
#include "support/layer_link.h"

#include <cstring>

namespace {

// The next ones down the chain; the program has one instance at a time.
PFN_vkGetInstanceProcAddr nextProc = nullptr;
PFN_vkGetPhysicalDeviceProperties nextProperties = nullptr;
PFN_vkGetPhysicalDeviceProperties2 nextProperties2 = nullptr;

void VKAPI_CALL properties(VkPhysicalDevice device, VkPhysicalDeviceProperties* given) {
    nextProperties(device, given);
    given->deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
}

void VKAPI_CALL properties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2* given) {
    nextProperties2(device, given);
    given->properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
}

template <class Function> void find(VkInstance instance, Function& function, const char* name) {
    function = reinterpret_cast<Function>(nextProc(instance, name));
}

VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocation,
                                   VkInstance* instance) {
    VkResult result = VK_SUCCESS;
    nextProc = voxtact::test::createNext(info, allocation, instance, result);
    if (result == VK_SUCCESS) {
        find(*instance, nextProperties, "vkGetPhysicalDeviceProperties");
        find(*instance, nextProperties2, "vkGetPhysicalDeviceProperties2");
    }
    return result;
}

PFN_vkVoidFunction VKAPI_CALL instanceProc(VkInstance instance, const char* name) {
    if (std::strcmp(name, "vkCreateInstance") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(createInstance);
    }
    if (std::strcmp(name, "vkGetPhysicalDeviceProperties") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(properties);
    }
    if (std::strcmp(name, "vkGetPhysicalDeviceProperties2") == 0 ||
        std::strcmp(name, "vkGetPhysicalDeviceProperties2KHR") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(properties2);
    }
    return nextProc == nullptr ? nullptr : nextProc(instance, name);
}

} // namespace

extern "C" __attribute__((visibility("default"))) VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* layer) {
    layer->loaderLayerInterfaceVersion = 2;
    layer->pfnGetInstanceProcAddr = instanceProc;
    layer->pfnGetDeviceProcAddr = nullptr;
    layer->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
