// SPDX-License-Identifier: MIT
// voxtact in a program that has Vulkan's functions under their own names: volk's pointers, or the linked loader.
#ifdef BESIDE_VOLK
#define VOLK_IMPLEMENTATION
#include <volk.h>
#else
#include <vulkan/vulkan.h>
#endif

#include "voxtact/context.h"

#include <cstdio>
#include <cstdlib>

int main() {
#ifdef BESIDE_VOLK
    if (volkInitialize() != VK_SUCCESS) {
        std::puts("no Vulkan loader");
        return 77;
    }
#endif
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo instanceInfo{};
    instanceInfo.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    instanceInfo.pApplicationInfo = &application;
    VkInstance instance = VK_NULL_HANDLE;
    if (vkCreateInstance(&instanceInfo, nullptr, &instance) != VK_SUCCESS) {
        std::puts("no Vulkan driver");
        return 77;
    }
#ifdef BESIDE_VOLK
    volkLoadInstance(instance);
#endif
    std::uint32_t one = 1;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    const VkResult found = vkEnumeratePhysicalDevices(instance, &one, &physicalDevice);
    if ((found != VK_SUCCESS && found != VK_INCOMPLETE) || one == 0) {
        std::puts("no Vulkan device");
        return 77;
    }
    const voxtact::FeatureRequest features(nullptr);
    const float priority = 1;
    VkDeviceQueueCreateInfo queueInfo{};
    queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    VkDeviceCreateInfo deviceInfo{};
    deviceInfo.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    deviceInfo.pNext = &features.features2;
    deviceInfo.queueCreateInfoCount = 1;
    deviceInfo.pQueueCreateInfos = &queueInfo;
    VkDevice device = VK_NULL_HANDLE;
    if (vkCreateDevice(physicalDevice, &deviceInfo, nullptr, &device) != VK_SUCCESS) {
        return EXIT_FAILURE;
    }
    voxtact::ContextDesc desc;
    desc.getInstanceProcAddr = vkGetInstanceProcAddr;
    desc.instance = instance;
    desc.physicalDevice = physicalDevice;
    desc.device = device;
    desc.apiVersion = VK_API_VERSION_1_3;
    desc.enabledFeatures = &features.features2;
    int status = EXIT_FAILURE;
    {
        const voxtact::Result<voxtact::Context> context = voxtact::Context::create(desc);
        if (context) {
            std::printf("default method %s\n", voxtact::toString(context->defaultMethod()));
            status = EXIT_SUCCESS;
        } else {
            std::printf("%s\n", context.error().text.c_str());
        }
    }
    vkDestroyDevice(device, nullptr);
    vkDestroyInstance(instance, nullptr);
    return status;
}
