// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/cells/piece_rows.h"
#include "host/search/opaque_part.h"

#include <glm/vec3.hpp>

#include <array>

namespace voxtact::cpu {

/// Starting points of walks through cells.
struct WalkJob {
    const OpaqueIntervals& intervals;
    const VolumeSpace& space;
    glm::dvec3 from{};  ///< local
    glm::dvec3 voxel{}; ///< the same, centred voxel coordinates
};

/// End points of walks.
struct alignas(kRowAlignment) WalkRows {
    std::array<PieceRows::Row, 3> at{}; ///< the cells' coordinates from -1 to 1
    PieceRows::Row distance{};          ///< mm from their start; infinite if nothing is certainly opaque
};

/// goToOpaque() in many cells at once, each from the point of its piece that is closest to `from` and within its piece.
/// After makeTerms(). The same on every processor.
void walkToOpaque(const WalkJob& job, const PieceRows& cells, WalkRows& out);

} // namespace voxtact::cpu
