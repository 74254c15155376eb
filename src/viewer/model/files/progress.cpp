// SPDX-License-Identifier: MIT
#include "viewer/model/files/progress.h"

#include <algorithm>

namespace voxtact::view {

Result<void> Progress::begin(std::string step) {
    if (cancelled_) {
        return Error{ErrorCode::Cancelled, 0, "cancelled before " + step};
    }
    const std::lock_guard lock(mutex_);
    now_ = {std::move(step), std::nullopt};
    return {};
}

bool Progress::tell(double share) {
    const std::lock_guard lock(mutex_);
    now_.share = std::clamp(share, 0.0, 1.0);
    return !cancelled_;
}

Progress::Now Progress::now() const {
    const std::lock_guard lock(mutex_);
    return now_;
}

} // namespace voxtact::view
