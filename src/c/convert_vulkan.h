// SPDX-License-Identifier: MIT
#pragma once

#include "c/convert.h"
#include "c/handles_vulkan.h"

/// Data of voxtact_vulkan.h as the C++ interface takes it.
namespace voxtact::c {

[[nodiscard]] ContextDesc toContextDesc(const vxt_context_desc* desc);
[[nodiscard]] QueueAccess toQueue(const vxt_queue* queue);
/// 0 stands for the usual one.
[[nodiscard]] inline VkImageLayout layoutOf(VkImageLayout given) noexcept {
    return given == VK_IMAGE_LAYOUT_UNDEFINED ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : given;
}

} // namespace voxtact::c
