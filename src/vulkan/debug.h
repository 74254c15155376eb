// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/context_impl.h"

namespace voxtact {

namespace detail {
void nameObject(ContextImpl& context, VkObjectType type, std::uint64_t handle, const char* name) noexcept;
template <class Handle> std::uint64_t handleBits(Handle handle) noexcept {
    if constexpr (std::is_pointer_v<Handle>) {
        return reinterpret_cast<std::uint64_t>(handle);
    } else {
        return handle;
    }
}
} // namespace detail

/// Names an object "voxtact NAME" for captures and validation messages; a long name is cut. Nothing without
/// VK_EXT_debug_utils. Takes no memory: what is named may have no owner yet.
template <class Handle>
void nameObject(ContextImpl& context, VkObjectType type, Handle handle, const char* name) noexcept {
    detail::nameObject(context, type, detail::handleBits(handle), name);
}

/// A label around the commands recorded during its life.
class Label {
  public:
    Label(ContextImpl& context, VkCommandBuffer commandBuffer, const char* text);
    Label(const Label&) = delete;
    Label& operator=(const Label&) = delete;
    ~Label();

  private:
    ContextImpl& context_;
    VkCommandBuffer commandBuffer_;
};

} // namespace voxtact
