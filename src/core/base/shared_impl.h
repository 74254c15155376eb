// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

namespace voxtact {

/// Base of an Impl that other objects share by shared_from_this() after its object ends. The object's pointer
/// represents a share that the Impl holds of itself; deleting it releases the share.
template <class Impl> class SharedImpl : public std::enable_shared_from_this<Impl> {
  public:
    /// The pointer for the object.
    [[nodiscard]] static std::unique_ptr<Impl> hold(const std::shared_ptr<Impl>& impl) noexcept {
        impl->self_ = impl;
        return std::unique_ptr<Impl>(impl.get());
    }
    /// For the object's destructor, and before assignment to it. The pointer may be null.
    static void letGo(std::unique_ptr<Impl>& pointer) noexcept {
        if (Impl* impl = pointer.release(); impl != nullptr) {
            const std::shared_ptr<Impl> share = std::move(impl->self_);
        }
    }

  private:
    std::shared_ptr<Impl> self_;
};

} // namespace voxtact
