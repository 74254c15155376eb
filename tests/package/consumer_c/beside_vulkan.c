/* SPDX-License-Identifier: MIT */
/* voxtact in a C program that has Vulkan's functions under their own names: volk's pointers, or the linked loader. */
#ifdef BESIDE_VOLK
#define VOLK_IMPLEMENTATION
#include <volk.h>
#else
#include <vulkan/vulkan.h>
#endif

#include "voxtact/voxtact_vulkan.h"

#include <stdio.h>
#include <stdlib.h>

static VkInstance make_instance(void) {
#ifdef BESIDE_VOLK
    if (volkInitialize() != VK_SUCCESS) {
        return VK_NULL_HANDLE;
    }
#endif
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    VkInstance instance = VK_NULL_HANDLE;
    if (vkCreateInstance(&info, NULL, &instance) != VK_SUCCESS) {
        return VK_NULL_HANDLE;
    }
#ifdef BESIDE_VOLK
    volkLoadInstance(instance);
#endif
    return instance;
}

static VkDevice make_device(VkPhysicalDevice physical_device, vxt_features* features) {
    const float priority = 1;
    VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = vxt_features_chain(features),
                               .queueCreateInfoCount = 1,
                               .pQueueCreateInfos = &queue};
    VkDevice device = VK_NULL_HANDLE;
    return vkCreateDevice(physical_device, &info, NULL, &device) == VK_SUCCESS ? device : VK_NULL_HANDLE;
}

static int print_default_method(VkInstance instance, VkPhysicalDevice physical_device, VkDevice device,
                                vxt_features* features) {
    const vxt_context_desc desc = {.struct_size = sizeof desc,
                                   .get_instance_proc_addr = vkGetInstanceProcAddr,
                                   .instance = instance,
                                   .physical_device = physical_device,
                                   .device = device,
                                   .api_version = VK_API_VERSION_1_3,
                                   .enabled_features = vxt_features_chain(features)};
    vxt_context* context;
    if (vxt_context_create(&desc, &context) != VXT_OK) {
        puts(vxt_last_error(NULL));
        return EXIT_FAILURE;
    }
    printf("default method %s\n", vxt_method_name(vxt_context_default_method(context)));
    vxt_context_destroy(context);
    return EXIT_SUCCESS;
}

int main(void) {
    VkInstance instance = make_instance();
    if (instance == VK_NULL_HANDLE) {
        puts("no Vulkan driver");
        return 77;
    }
    uint32_t one = 1;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    const VkResult found = vkEnumeratePhysicalDevices(instance, &one, &physical_device);
    if ((found != VK_SUCCESS && found != VK_INCOMPLETE) || one == 0) {
        puts("no Vulkan device");
        return 77;
    }
    vxt_features* features;
    if (vxt_features_create(NULL, &features) != VXT_OK) {
        return EXIT_FAILURE;
    }
    VkDevice device = make_device(physical_device, features);
    if (device == VK_NULL_HANDLE) {
        return EXIT_FAILURE;
    }
    const int status = print_default_method(instance, physical_device, device, features);
    vxt_features_destroy(features);
    vkDestroyDevice(device, NULL);
    vkDestroyInstance(instance, NULL);
    return status;
}
