// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scene/scene_impl.h"

#include <algorithm>
#include <list>

namespace voxtact::cpu {

/// Transfer functions under which everything is opaque. They are kept, so that what is made with one is found again.
class AllOpaque {
  public:
    /// Over the values of a domain: of another's, numbers might be too large. It lives until there were many others.
    [[nodiscard]] const TransferFunctionImpl& over(const ValueRange& domain) {
        constexpr std::size_t kMost = 16;
        const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const TransferFunctionImpl& one) {
            return one.domain.lo == domain.lo && one.domain.hi == domain.hi;
        });
        if (found != kept_.end()) {
            return *found;
        }
        if (kept_.size() == kMost) {
            kept_.pop_front();
        }
        kept_.push_back({nextObjectId(), domain, {1, 1}});
        return kept_.back();
    }

  private:
    std::list<TransferFunctionImpl> kept_;
};

} // namespace voxtact::cpu
