// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/refuse.h"
#include "core/base/text.h"
#include "voxtact/data.h"

namespace voxtact {

/// Refuses a length in mm that no grid could have between its voxels. `what` begins the error text.
[[nodiscard]] inline Result<void> checkLength(double length, const std::string& what) {
    return length >= kLeastSpacing && length <= kMostSpacing
               ? Result<void>()
               : refuse(what + " is " + number(length) + " mm, it must be from " + number(kLeastSpacing) + " to " +
                        number(kMostSpacing));
}

} // namespace voxtact
