// SPDX-License-Identifier: MIT
#pragma once

#include "host/overlap/overlap_labels.h"
#include "host/overlap/overlap_part.h"
#include "host/overlap/pair_surface.h"
#include "host/overlap/solid_surface.h"
#include "host/search/pair_at.h"
#include "voxtact/overlap.h"

#include <memory>
#include <optional>
#include <vector>

namespace voxtact::cpu {

/// A batch item, prepared for all of its poses.
struct OverlapItem {
    std::shared_ptr<const SolidSurface> solid;
    std::shared_ptr<const OverlapPart> part;
    /// The whole volume, then the parts at or above each limit of the bands; empty: no bands.
    std::vector<std::shared_ptr<const OverlapPart>> limits;
    const OverlapLabels* labels = nullptr; ///< null: no labels
    bool wantsPoint = false;               ///< PairMeasures::inside
};

/// mm^3.
struct Measure {
    Bounds bounds;
    Containment inside = Containment::None;
    StopReason end = StopReason::Closed;
};

/// Outputs of a pair.
struct PairMeasures {
    Measure whole;
    Bounds solid;
    std::vector<Measure> bands;
    std::vector<Measure> labels; ///< by slot
    std::optional<Vec3> inside;  ///< on request: a point that is certainly opaque and inside, world mm
};

/// Memory reused between pairs, for one thread.
struct OverlapMemory {
    MeshPlace& mesh;
    PairSurface& surface;
};

/// Measures a pair, with the same result on every processor.
[[nodiscard]] PairMeasures measurePair(const Overlap& question, const OverlapItem& made, const BatchItem& item,
                                       const Mat4& world_from_object, const OverlapMemory& memory, CancelFlag cancel);

} // namespace voxtact::cpu
