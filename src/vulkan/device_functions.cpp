// SPDX-License-Identifier: MIT
#include "vulkan/device_functions.h"

namespace voxtact {

const char* DeviceFunctions::load(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance, VkDevice device,
                                  bool debugUtils) noexcept {
    // The loaders hand out one generic function type; the name says which it really is.
#define VOXTACT_LOAD_INSTANCE(name)                                                                                    \
    name = reinterpret_cast<PFN_vk##name>(getInstanceProcAddr(instance, "vk" #name));                                  \
    if (name == nullptr) {                                                                                             \
        return "vk" #name;                                                                                             \
    }
    VOXTACT_INSTANCE_FUNCTIONS(VOXTACT_LOAD_INSTANCE)
#undef VOXTACT_LOAD_INSTANCE
#define VOXTACT_LOAD_DEVICE(name)                                                                                      \
    name = reinterpret_cast<PFN_vk##name>(GetDeviceProcAddr(device, "vk" #name));                                      \
    if (name == nullptr) {                                                                                             \
        return "vk" #name;                                                                                             \
    }
    VOXTACT_DEVICE_FUNCTIONS(VOXTACT_LOAD_DEVICE)
#undef VOXTACT_LOAD_DEVICE
    if (debugUtils) {
#define VOXTACT_LOAD_DEBUG(name) name = reinterpret_cast<PFN_vk##name>(GetDeviceProcAddr(device, "vk" #name));
        VOXTACT_DEBUG_FUNCTIONS(VOXTACT_LOAD_DEBUG)
#undef VOXTACT_LOAD_DEBUG
    }
    return nullptr;
}

} // namespace voxtact
