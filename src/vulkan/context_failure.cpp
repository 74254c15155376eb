// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "vulkan/context_impl.h"

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

Result<void> ContextImpl::recordable(VkCommandBuffer commandBuffer) const {
    if (commandBuffer == VK_NULL_HANDLE) {
        return refuse("the command buffer is null");
    }
    return alive();
}

void ContextImpl::giveUp(VkResult result) noexcept {
    givenUp.store(true);
    lost.store(true);
    // What cannot be said for want of memory is left out.
    static_cast<void>(guard([&]() -> Result<void> {
        log("a submission cannot be waited for (VkResult " + std::to_string(static_cast<std::int32_t>(result)) +
            "): the device counts as lost, and what the Context made is left to it");
        return {};
    }));
}

bool mayDestroy(const ContextImpl& context) noexcept {
    return !context.givenUp.load();
}

Result<void> ContextImpl::alive() const {
    if (givenUp.load()) {
        return Error{ErrorCode::DeviceLost, VK_ERROR_DEVICE_LOST,
                     "a submission could not be waited for earlier: the device counts as lost"};
    }
    if (lost.load()) {
        return Error{ErrorCode::DeviceLost, VK_ERROR_DEVICE_LOST, "the device was lost earlier"};
    }
    return {};
}

} // namespace voxtact
