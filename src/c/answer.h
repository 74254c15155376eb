// SPDX-License-Identifier: MIT
#pragma once

#include "c/errors.h"
#include "voxtact/results.h"

#include <optional>
#include <span>
#include <vector>

struct vxt_answer {
    std::vector<vxt_pair> pairs;
    std::vector<vxt_touched_triangle> triangles;
    std::vector<vxt_contact> contacts;
    std::vector<vxt_box> bounds;
    std::vector<vxt_label_count> labels;
    std::uint64_t contactsFound = 0;
    std::optional<voxtact::CertifiedCounters> counters;
    std::optional<std::vector<voxtact::PairClearance>> clearances; ///< where they were measured
    std::vector<voxtact::LabelClearance> labelClearances;
    std::vector<voxtact::SegmentMotion> motions;
    double gpuMilliseconds = 0;
    double wallMilliseconds = 0;
};

namespace voxtact::c {

/// The C interface's form of an answer.
[[nodiscard]] vxt_answer toAnswer(const BatchAnswer& answer);

} // namespace voxtact::c
