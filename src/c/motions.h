// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/motion.h"
#include "voxtact/voxtact_motion.h"

#include <vector>

struct vxt_motions {
    std::vector<vxt_segment_motion> segments;
    double wallMilliseconds = 0;
};

namespace voxtact::c {

/// The C interface's form of motions.
[[nodiscard]] vxt_motions toMotions(const std::vector<SegmentMotion>& motions, double wallMilliseconds);

} // namespace voxtact::c
