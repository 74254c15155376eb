// SPDX-License-Identifier: MIT
#pragma once

#include "oracle/oracle.h"
#include "voxtact/data.h"

#include <cstdint>

/// The oracle of clearances: double precision, no hierarchy, nothing but sub-boxes of cells and the distances of their
/// middles to all triangles. Of the opaque part it says what the certified oracle says.
namespace voxtact::oracle {

/// The clearance is within it, mm, up to some roundings of a coordinate.
struct OracleClearance {
    double lo = 0;
    double hi = 0;
};

/// Sub-boxes are divided until they are no longer than `resolution` voxels, or until there are more than `mostBoxes`.
/// The pair's view is ignored. Refuses what certifiedOracle() refuses.
[[nodiscard]] Result<OracleClearance> clearanceOracle(const OraclePair& pair, double resolution,
                                                      std::size_t mostBoxes = 100000);

/// The same to what is opaque and in a closed box around a voxel with the label. The map is on the volume's grid.
[[nodiscard]] Result<OracleClearance> labelClearanceOracle(const OraclePair& pair, const LabelData& labels,
                                                           std::int32_t label, double resolution,
                                                           std::size_t mostBoxes = 100000);

} // namespace voxtact::oracle
