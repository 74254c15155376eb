// SPDX-License-Identifier: MIT
#pragma once

#include "host/cancel.h"
#include "host/overlap/overlap_labels.h"
#include "host/overlap/overlap_part.h"
#include "host/overlap/pair_surface.h"
#include "voxtact/overlap.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voxtact::cpu {

/// Inputs of a measurement.
struct OverlapGoal {
    double tolerance = 0;        ///< voxels: stop when upper - lower of each sum is at most this
    std::uint64_t maxSteps = 0;  ///< maximum number of boxes to divide for each sum
    CancelFlag cancel = nullptr; ///< the result of a cancelled measurement is undefined
    /// Voxels: minimum volume of a proof. Division continues for a while, until such a volume is found inside and
    /// outside the solid, or certainly none exists.
    double error = 0;
    bool isSomeOutside = false; ///< an opaque region is known outside
};

/// One sum.
struct OverlapFound {
    Bounds bounds; ///< voxels
    StopReason end{};
    bool isCrossed = false;  ///< the surface is in cells that may be opaque
    bool mayOverlap = false; ///< false: no opaque point is inside
    bool mayLeave = false;   ///< false: all opaque points of the cells that were crossed are inside
    double outside = 0;      ///< voxels that are certainly opaque and not inside, of these cells
};

/// The opaque region behind a pair's surface. The same on every processor. `labels`: null where there is one sum.
[[nodiscard]] std::vector<OverlapFound> measureOverlap(const VolumeImpl& volume, const OverlapPart& part,
                                                       const PairSurface& surface, const OverlapLabels* labels,
                                                       const OverlapGoal& goal);

} // namespace voxtact::cpu
