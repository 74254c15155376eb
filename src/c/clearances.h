// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/clearance.h"
#include "voxtact/voxtact_clearance.h"

#include <vector>

struct vxt_clearances {
    std::vector<vxt_pair_clearance> pairs;
    std::vector<vxt_label_clearance> labels;
    double wallMilliseconds = 0;
};

namespace voxtact::c {

/// The C interface's form of a clearance.
[[nodiscard]] vxt_pair_clearance toClearance(const PairClearance& pair) noexcept;
[[nodiscard]] vxt_label_clearance toLabelClearance(const LabelClearance& label) noexcept;

} // namespace voxtact::c
