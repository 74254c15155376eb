// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/own/vulkan_device.h"

namespace voxtact::device {

/// The instance's functions, looked up for this instance.
struct InstanceFunctions {
    PFN_vkDestroyInstance destroyInstance = nullptr;
    PFN_vkEnumeratePhysicalDevices enumeratePhysicalDevices = nullptr;
    PFN_vkGetPhysicalDeviceProperties getPhysicalDeviceProperties = nullptr;
    PFN_vkGetPhysicalDeviceProperties2 getPhysicalDeviceProperties2 = nullptr;
    PFN_vkGetPhysicalDeviceFeatures2 getPhysicalDeviceFeatures2 = nullptr;
    PFN_vkGetPhysicalDeviceQueueFamilyProperties getPhysicalDeviceQueueFamilyProperties = nullptr;
    PFN_vkEnumerateDeviceExtensionProperties enumerateDeviceExtensionProperties = nullptr;
    PFN_vkCreateDevice createDevice = nullptr;
    PFN_vkCreateDebugUtilsMessengerEXT createDebugUtilsMessenger = nullptr;
    PFN_vkDestroyDebugUtilsMessengerEXT destroyDebugUtilsMessenger = nullptr;
};

struct VulkanInstance::State {
    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State();

    VkInstance instance = VK_NULL_HANDLE;
    InstanceFunctions functions;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    std::vector<const char*> extensions;
    std::shared_ptr<ValidationMessages> messages = std::make_shared<ValidationMessages>();
};

} // namespace voxtact::device
