// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <atomic>

namespace voxtact::cpu {

/// Batch::cancel of the call at hand, which may be null.
using CancelFlag = const std::atomic<bool>*;

[[nodiscard]] inline bool isCancelled(CancelFlag cancel) noexcept {
    return cancel != nullptr && cancel->load(std::memory_order_relaxed);
}

/// What a cancelled call returns in place of what it has so far, which says nothing of any pair.
[[nodiscard]] inline Result<void> checkNotCancelled(CancelFlag cancel) {
    if (isCancelled(cancel)) {
        return Error{ErrorCode::Cancelled, 0, "the call was cancelled (Batch::cancel)"};
    }
    return {};
}

} // namespace voxtact::cpu
