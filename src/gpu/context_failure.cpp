// SPDX-License-Identifier: MIT
#include "gpu/context_impl.h"

namespace voxtact {

Error ContextImpl::failure(VkResult result, const char* what) noexcept {
    const auto code = static_cast<std::int32_t>(result);
    switch (result) {
    case VK_ERROR_DEVICE_LOST:
        lost.store(true);
        return {ErrorCode::DeviceLost, code, std::string("the device was lost while ") + what};
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return {ErrorCode::OutOfMemory, code, std::string("out of device memory while ") + what};
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return {ErrorCode::OutOfMemory, code, std::string("out of host memory while ") + what};
    default:
        return {ErrorCode::Vulkan, code, std::string(what) + " failed with VkResult " + std::to_string(code)};
    }
}

Result<void> ContextImpl::alive() const {
    if (lost.load()) {
        return Error{ErrorCode::DeviceLost, VK_ERROR_DEVICE_LOST, "the device was lost earlier"};
    }
    return {};
}

} // namespace voxtact
