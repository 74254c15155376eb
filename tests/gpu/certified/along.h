// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/detector.h"

namespace voxtact::test {

/// A detector that looks along motions.
inline DetectorDesc along(const MotionSearch& search = {}) {
    return {.method = CountingMethod::Compute,
            .projection = Projection::Conservative,
            .stopAtFirst = true,
            .motion = search};
}

} // namespace voxtact::test
