// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan_core.h>

/// Link to the next Vulkan layer in the chain.
namespace voxtact::test {

/// The part of a create info's chain that the loader has for layers.
template <class Link> Link* linkOf(const void* chain, VkStructureType type) {
    auto* link = static_cast<Link*>(const_cast<void*>(chain));
    while (link != nullptr && !(link->sType == type && link->function == VK_LAYER_LINK_INFO)) {
        link = static_cast<Link*>(const_cast<void*>(link->pNext));
    }
    return link;
}

/// Makes the instance with the next one. Returns its way to functions.
inline PFN_vkGetInstanceProcAddr createNext(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocation,
                                            VkInstance* instance, VkResult& result) {
    auto* const link = linkOf<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    const PFN_vkGetInstanceProcAddr next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(next(VK_NULL_HANDLE, "vkCreateInstance"));
    result = create(info, allocation, instance);
    return next;
}

} // namespace voxtact::test
