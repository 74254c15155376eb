// SPDX-License-Identifier: MIT
#include "interception.h"

#include <cstring>

namespace voxtact::test {

namespace {
Interception* current = nullptr;
} // namespace

Interception::Interception(PFN_vkGetInstanceProcAddr real) : real_(real) {
    current = this;
}

Interception::~Interception() {
    current = nullptr;
}

PFN_vkGetInstanceProcAddr Interception::getInstanceProcAddr() {
    return &Interception::fromInstance;
}

PFN_vkVoidFunction VKAPI_PTR Interception::fromInstance(VkInstance instance, const char* name) {
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
        current->realGetDeviceProcAddr_ = reinterpret_cast<PFN_vkGetDeviceProcAddr>(current->real_(instance, name));
        return reinterpret_cast<PFN_vkVoidFunction>(&Interception::fromDevice);
    }
    if (const auto found = current->replaced_.find(name); found != current->replaced_.end()) {
        return found->second;
    }
    return current->real_(instance, name);
}

PFN_vkVoidFunction VKAPI_PTR Interception::fromDevice(VkDevice device, const char* name) {
    if (const auto found = current->replaced_.find(name); found != current->replaced_.end()) {
        return found->second;
    }
    return current->realGetDeviceProcAddr_(device, name);
}

} // namespace voxtact::test
