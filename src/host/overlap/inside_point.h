// SPDX-License-Identifier: MIT
#pragma once

#include "host/cancel.h"
#include "host/overlap/overlap_part.h"
#include "host/overlap/pair_surface.h"

#include <optional>

namespace voxtact::cpu {

/// Finds a point that is certainly opaque and certainly inside the solid, world mm. The mesh is in place, as for
/// PairSurface::begin(). Empty if rounding decides, after many points outside, and if the surface divides an opaque
/// component.
[[nodiscard]] std::optional<Vec3> opaquePointInside(const VolumeImpl& volume, const OverlapPart& part,
                                                    const PairSurface& surface, MeshPlace& mesh, CancelFlag cancel);

} // namespace voxtact::cpu
