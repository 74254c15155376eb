// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/refuse.h"
#include "core/base/text.h"
#include "voxtact/data.h"

#include <cmath>

namespace voxtact {

/// Refuses the domain of a transfer function that is not finite, is empty, or so wide that its width overflows. `what`
/// begins the error text.
inline Result<void> checkDomain(const ValueRange& domain, const std::string& what) {
    const auto isWrong = [&](const char* reason) {
        return refuse(what + " " + number(domain.lo) + ":" + number(domain.hi) + " is " + reason);
    };
    if (!std::isfinite(domain.lo) || !std::isfinite(domain.hi)) {
        return isWrong("not finite");
    }
    if (!(domain.lo < domain.hi)) {
        return isWrong("empty, the lower end must be below the upper one");
    }
    if (!std::isfinite(domain.hi - domain.lo)) {
        return isWrong("too wide, the difference of its ends overflows");
    }
    return {};
}

} // namespace voxtact
