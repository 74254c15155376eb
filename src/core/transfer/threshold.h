// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/refuse.h"
#include "core/base/text.h"
#include "voxtact/error.h"

namespace voxtact {

/// Refuses a threshold outside [0,1].
[[nodiscard]] inline Result<void> checkThreshold(double threshold) {
    return threshold >= 0 && threshold <= 1 ? Result<void>()
                                            : refuse("the threshold " + number(threshold) + " is outside [0, 1]");
}

} // namespace voxtact
