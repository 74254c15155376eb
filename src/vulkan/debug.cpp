// SPDX-License-Identifier: MIT
#include "vulkan/debug.h"

#include <array>
#include <cstdio>

namespace voxtact {

void detail::nameObject(ContextImpl& context, VkObjectType type, std::uint64_t handle, const char* name) noexcept {
    if (context.vk.SetDebugUtilsObjectNameEXT == nullptr) {
        return;
    }
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "voxtact %s", name == nullptr ? "object" : name);
    VkDebugUtilsObjectNameInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = text.data();
    // A name that cannot be set is no reason to fail.
    static_cast<void>(context.vk.SetDebugUtilsObjectNameEXT(context.device, &info));
}

Label::Label(ContextImpl& context, VkCommandBuffer commandBuffer, const char* text)
    : context_(context), commandBuffer_(commandBuffer) {
    if (context_.vk.CmdBeginDebugUtilsLabelEXT != nullptr) {
        VkDebugUtilsLabelEXT label{};
        label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
        label.pLabelName = text;
        context_.vk.CmdBeginDebugUtilsLabelEXT(commandBuffer_, &label);
    }
}

Label::~Label() {
    if (context_.vk.CmdEndDebugUtilsLabelEXT != nullptr) {
        context_.vk.CmdEndDebugUtilsLabelEXT(commandBuffer_);
    }
}

} // namespace voxtact
