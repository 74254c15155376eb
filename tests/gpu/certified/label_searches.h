// SPDX-License-Identifier: MIT
#pragma once

#include "support/scenes.h"
#include "voxtact/detector.h"

#include <gtest/gtest.h>

namespace voxtact::test {

inline DetectorDesc toLabels(const ClearanceSearch& search = {}, bool anyOpacity = false) {
    return {.method = CountingMethod::Compute,
            .projection = Projection::Conservative,
            .stopAtFirst = true,
            .clearance = search,
            .labelClearances = true,
            .labelsAtAnyOpacity = anyOpacity};
}

/// Whether a number can be between both.
inline void expectBothCanBe(const ClearanceBounds& device, const ClearanceBounds& host) {
    EXPECT_LE(device.lo, device.hi);
    EXPECT_LE(device.lo, host.hi);
    EXPECT_LE(host.lo, device.hi);
}

/// A label map of numbers that `labelOf` says by voxel.
template <class LabelOf> LabelData mapOf(const Grid& grid, const LabelOf& labelOf) {
    return take(makeLabels(makeBytes(grid, labelOf).view()));
}

} // namespace voxtact::test
