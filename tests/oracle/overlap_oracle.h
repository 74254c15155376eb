// SPDX-License-Identifier: MIT
#pragma once

#include "oracle/oracle.h"
#include "voxtact/overlap.h"

#include <cstddef>
#include <vector>

/// The oracle of overlaps: double precision, no hierarchy, nothing but boxes in index space that are divided until no
/// triangle meets a box and the values in it are all on one side of each limit. A box that no triangle meets is inside
/// where the winding number of its centre is not 0, which is a sum of solid angles over all triangles.
namespace voxtact::oracle {

/// The opaque region of one label.
struct OracleLabelOverlap {
    Bounds inside;  ///< mm^3 inside the solid
    Bounds outside; ///< mm^3 elsewhere in the image; boxes of half a voxel are not divided
};

/// Bounds up to a relative error of 1e-12, mm^3.
struct OracleOverlap {
    Bounds inside;               ///< of the opaque region inside the solid
    Bounds outside;              ///< of the rest of it; boxes of half a voxel are not divided
    Bounds solid;                ///< of the part of the solid that is in the image
    std::vector<Bounds> bands{}; ///< one more than limits; empty where there is no limit
    std::vector<OracleLabelOverlap> labels{};
};

/// Boxes are divided until there are more than `maxBoxes` of them to go on with. The pair's view and the question's
/// tolerance and steps are ignored. `labels` may be null where the question has none; its grid is the volume's. Refuses
/// what certifiedOracle() refuses, and a mesh with holes where a winding number shows it.
[[nodiscard]] Result<OracleOverlap> overlapOracle(const OraclePair& pair, const Overlap& question = {},
                                                  const LabelData* labels = nullptr, std::size_t maxBoxes = 40000);

/// Bounds of the volume of the whole solid at its pose, mm^3, wherever the image is.
[[nodiscard]] Result<Bounds> solidOracle(const OraclePair& pair, std::size_t maxBoxes = 40000);

} // namespace voxtact::oracle
