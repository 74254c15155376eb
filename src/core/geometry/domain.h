// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/text.h"
#include "voxtact/data.h"

#include <cmath>

namespace voxtact {

/// Refuses the domain of a transfer function that is not finite, is empty, or so wide that its width overflows. `what`
/// begins the error text.
inline Result<void> checkDomain(const ValueRange& domain, const std::string& what) {
    const auto refuse = [&](const char* reason) {
        return Error{ErrorCode::InvalidArgument, 0,
                     what + " " + number(domain.lo) + ":" + number(domain.hi) + " is " + reason};
    };
    if (!std::isfinite(domain.lo) || !std::isfinite(domain.hi)) {
        return refuse("not finite");
    }
    if (!(domain.lo < domain.hi)) {
        return refuse("empty, the lower end must be below the upper one");
    }
    if (!std::isfinite(domain.hi - domain.lo)) {
        return refuse("too wide, the difference of its ends overflows");
    }
    return {};
}

} // namespace voxtact
