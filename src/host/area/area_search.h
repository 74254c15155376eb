// SPDX-License-Identifier: MIT
#pragma once

#include "host/area/label_cut.h"
#include "host/cancel.h"
#include "host/search/mesh_place.h"
#include "voxtact/area.h"

#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// Inputs of a measurement.
struct AreaGoal {
    double tolerance = 0;        ///< mm^2: how near to each other the bounds of each sum are brought
    std::uint64_t maxSteps = 0;  ///< maximum number of divisions
    CancelFlag cancel = nullptr; ///< the result of a cancelled measurement is undefined
};

/// Result of a measurement.
struct AreaFound {
    Bounds bounds;
    StopReason end{};
};

/// Area of one triangle.
struct TriangleFound {
    std::uint32_t triangle = 0; ///< number in the mesh
    double whole = 0;           ///< mm^2, of the whole triangle
    Bounds bounds;
};

/// The contact area of a mesh that is in place: parts of its triangles, each in a cell, between bounds; and those
/// whose bounds are farthest apart divided, until all together are within the tolerance. The same on every processor.
/// `triangles`: null, or where those go that may have an area, by number.
[[nodiscard]] AreaFound measureArea(const VolumeImpl& volume, const OpaquePart& part, MeshPlace& mesh,
                                    const AreaGoal& goal, std::vector<TriangleFound>* triangles = nullptr);

/// Like the measurement above, for the opaque parts with some labels by labelAt(): one slot per label, each with its
/// own iterations.
[[nodiscard]] std::vector<AreaFound> measureAreas(const VolumeImpl& volume, const OpaquePart& part, MeshPlace& mesh,
                                                  const AreaLabels& labels, std::size_t slots, const AreaGoal& goal);

} // namespace voxtact::cpu
