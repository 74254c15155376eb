// SPDX-License-Identifier: MIT
#include "play.h"

namespace voxtact::test {

namespace {

ErrorCode codeOf(VkResult result) {
    switch (result) {
    case VK_ERROR_DEVICE_LOST:
        return ErrorCode::DeviceLost;
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return ErrorCode::OutOfMemory;
    default:
        return ErrorCode::Vulkan;
    }
}

} // namespace

void Play::expectFault(const char* what, const Error& error) {
    const std::string told = std::string(what) + ": '" + error.text + "'";
    error_ = error.text;
    if (stage_.faults.failed().empty()) {
        complain(told + " came without a fault");
        throw PlayEnds(told);
    }
    const VkResult result = stage_.faults.fault()->result;
    // What was being done, and of what: "making a buffer" is the least.
    if (error.text.find(' ') == std::string::npos || error.text.find('\n') != std::string::npos) {
        complain(told + " says nothing");
    }
    // An initialisation that fails while devices are listed is how some loaders say that there is none.
    const bool noDevice =
        stage_.faults.failed() == "vkEnumeratePhysicalDevices" && error.code == ErrorCode::Unsupported;
    if ((error.code != codeOf(result) && !noDevice) || error.vkResult != result) {
        complain(told + " has code " + std::to_string(static_cast<std::uint32_t>(error.code)) + " and VkResult " +
                 std::to_string(error.vkResult) + ", the fault was " + std::to_string(result));
    }
    lost_ = result == VK_ERROR_DEVICE_LOST;
}

void Play::expectAgain(const char* what, const Error* error) {
    const std::string told = std::string(what) + ", called again after a fault, ";
    if (lost_) {
        if (error == nullptr || error->code != ErrorCode::DeviceLost) {
            complain(told + "does not say that the device is lost: " + (error == nullptr ? "ok" : error->text));
        }
        throw PlayEnds("the device is lost");
    }
    if (error != nullptr) {
        complain(told + "fails: " + error->text);
        throw PlayEnds(error->text);
    }
}

} // namespace voxtact::test
