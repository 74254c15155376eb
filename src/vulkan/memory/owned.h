// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

namespace voxtact {

struct ContextImpl;

/// False once the context is given up: ContextImpl::giveUp().
[[nodiscard]] bool mayDestroy(const ContextImpl& context) noexcept;

/// One owned Vulkan object: destroyed with its context's device and allocator. Move-only.
template <class Handle> class Owned {
  public:
    using Destroy = void (*)(ContextImpl&, Handle);

    Owned() = default;
    Owned(ContextImpl& context, Handle handle, Destroy destroy) noexcept
        : context_(&context), handle_(handle), destroy_(destroy) {}
    Owned(Owned&& other) noexcept
        : context_(other.context_), handle_(std::exchange(other.handle_, Handle{})), destroy_(other.destroy_) {}
    Owned& operator=(Owned&& other) noexcept {
        if (this != &other) {
            reset();
            context_ = other.context_;
            handle_ = std::exchange(other.handle_, Handle{});
            destroy_ = other.destroy_;
        }
        return *this;
    }
    ~Owned() { reset(); }

    [[nodiscard]] Handle get() const noexcept { return handle_; }
    explicit operator bool() const noexcept { return handle_ != Handle{}; }
    void reset() noexcept {
        if (handle_ == Handle{}) {
            return;
        }
        const Handle ended = std::exchange(handle_, Handle{});
        if (mayDestroy(*context_)) {
            destroy_(*context_, ended);
        }
    }

  private:
    ContextImpl* context_ = nullptr;
    Handle handle_{};
    Destroy destroy_ = nullptr;
};

} // namespace voxtact
