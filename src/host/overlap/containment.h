// SPDX-License-Identifier: MIT
#pragma once

#include "host/overlap/overlap_search.h"

#include <span>
#include <vector>

namespace voxtact::cpu {

/// Facts about a pair in addition to its sums.
struct ContainmentFacts {
    double error = 0;           ///< voxels: no volume is off by more
    double reach = 0;           ///< voxels: no place is off by more
    bool mayTouch = true;       ///< false: the surface certainly has no opaque point
    bool isSomeOutside = false; ///< there certainly is something opaque outside
};

/// Containment of the part that each sum measures.
[[nodiscard]] std::vector<Containment> containmentsOf(const VolumeImpl& volume, const OverlapPart& part,
                                                      const PairSurface& surface, const OverlapLabels* labels,
                                                      std::span<const OverlapFound> found,
                                                      const ContainmentFacts& facts);

} // namespace voxtact::cpu
