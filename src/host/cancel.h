// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <atomic>

namespace voxtact::cpu {

/// Batch::cancel of one call, which may be null. Cancellation is permanent for the call: resetting the flag does not
/// turn an incomplete call into an answer.
class Cancellation {
  public:
    explicit Cancellation(const std::atomic<bool>* asked) noexcept : asked_(asked) {}

    [[nodiscard]] bool seen() const noexcept {
        if (asked_ == nullptr) {
            return false;
        }
        if (asked_->load(std::memory_order_relaxed)) {
            seen_.store(true, std::memory_order_relaxed);
        }
        return seen_.load(std::memory_order_relaxed);
    }

  private:
    const std::atomic<bool>* asked_;
    mutable std::atomic<bool> seen_ = false;
};

/// Cancel flag of the current call; null: none.
using CancelFlag = const Cancellation*;

[[nodiscard]] inline bool isCancelled(CancelFlag cancel) noexcept {
    return cancel != nullptr && cancel->seen();
}

/// Refuses a cancelled call, which returns no partial results.
[[nodiscard]] inline Result<void> checkNotCancelled(const Cancellation& cancel) {
    if (cancel.seen()) {
        return Error{ErrorCode::Cancelled, 0, "the call was cancelled (Batch::cancel)"};
    }
    return {};
}

} // namespace voxtact::cpu
