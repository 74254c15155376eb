// SPDX-License-Identifier: MIT
// A Vulkan layer that lets calls fail when a test asks for it: by the file that VOXTACT_FAULT names. "lost" in it: the
// next submission, and all after it on the same device, find the device lost. "surface": the next image that is shown
// finds the surface lost. The file is gone when that has happened. The layer is between the program and the validation.
#include "support/layer_link.h"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <string>

#include <unistd.h>

namespace {

using namespace voxtact::test;

struct Device {
    PFN_vkGetDeviceProcAddr next = nullptr;
    PFN_vkQueueSubmit2 submit = nullptr;
    PFN_vkQueuePresentKHR present = nullptr;
    bool lost = false;
};

std::mutex mutex;
PFN_vkGetInstanceProcAddr nextInstance = nullptr;
std::map<void*, Device> devices; // by the pointer that a device and its queues begin with

template <class Handle> void* keyOf(Handle handle) {
    return *reinterpret_cast<void**>(handle);
}

/// Whether the test asks for it now; it has then happened.
bool wanted(const char* fault) {
    const char* const path = std::getenv("VOXTACT_FAULT");
    std::string text;
    if (path != nullptr) {
        std::ifstream(path) >> text;
    }
    return text == fault && unlink(path) == 0;
}

VkResult VKAPI_CALL queueSubmit2(VkQueue queue, std::uint32_t count, const VkSubmitInfo2* infos, VkFence fence) {
    PFN_vkQueueSubmit2 submit = nullptr;
    {
        const std::lock_guard lock(mutex);
        Device& device = devices[keyOf(queue)];
        device.lost = device.lost || wanted("lost");
        if (device.lost) {
            return VK_ERROR_DEVICE_LOST;
        }
        submit = device.submit;
    }
    return submit(queue, count, infos, fence);
}

VkResult VKAPI_CALL queuePresent(VkQueue queue, const VkPresentInfoKHR* info) {
    PFN_vkQueuePresentKHR present = nullptr;
    {
        const std::lock_guard lock(mutex);
        if (wanted("surface")) {
            return VK_ERROR_SURFACE_LOST_KHR;
        }
        present = devices[keyOf(queue)].present;
    }
    return present(queue, info);
}

VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocation,
                                   VkInstance* instance) {
    VkResult result = VK_SUCCESS;
    nextInstance = createNext(info, allocation, instance, result);
    return result;
}

VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                 const VkAllocationCallbacks* allocation, VkDevice* device) {
    auto* const link = linkOf<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    const PFN_vkGetInstanceProcAddr instanceProc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const PFN_vkGetDeviceProcAddr next = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(instanceProc(VK_NULL_HANDLE, "vkCreateDevice"));
    const VkResult result = create(physical, info, allocation, device);
    if (result == VK_SUCCESS) {
        Device made;
        made.next = next;
        made.submit = reinterpret_cast<PFN_vkQueueSubmit2>(next(*device, "vkQueueSubmit2"));
        made.present = reinterpret_cast<PFN_vkQueuePresentKHR>(next(*device, "vkQueuePresentKHR"));
        const std::lock_guard lock(mutex);
        devices[keyOf(*device)] = made;
    }
    return result;
}

PFN_vkVoidFunction VKAPI_CALL deviceProc(VkDevice device, const char* name) {
    if (std::strcmp(name, "vkQueueSubmit2") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(queueSubmit2);
    }
    if (std::strcmp(name, "vkQueuePresentKHR") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(queuePresent);
    }
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(deviceProc);
    }
    const std::lock_guard lock(mutex);
    return devices[keyOf(device)].next(device, name);
}

PFN_vkVoidFunction VKAPI_CALL instanceProc(VkInstance instance, const char* name) {
    if (std::strcmp(name, "vkCreateInstance") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(createInstance);
    }
    if (std::strcmp(name, "vkCreateDevice") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(createDevice);
    }
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(deviceProc);
    }
    return nextInstance == nullptr ? nullptr : nextInstance(instance, name);
}

} // namespace

extern "C" __attribute__((visibility("default"))) VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* layer) {
    layer->loaderLayerInterfaceVersion = 2;
    layer->pfnGetInstanceProcAddr = instanceProc;
    layer->pfnGetDeviceProcAddr = deviceProc;
    layer->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
