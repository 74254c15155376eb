// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/try.h"
#include "voxtact/cpu.h"

#include <cstddef>
#include <vector>

namespace voxtact::cpu {

/// Refuses meshes without an inside.
[[nodiscard]] inline Result<void> checkSolids(HostEngine& engine, const Batch& batch) {
    std::vector<BatchItem> items(batch.items.begin(), batch.items.end());
    for (BatchItem& item : items) {
        item.world_from_object = {};
    }
    Batch noPoses = batch;
    noPoses.items = items;
    VOXTACT_TRY(engine.ask(Overlap{}, noPoses));
    return {};
}

/// Calls `use(pair, containment)` for the pairs of a batch that `isFree(pair)` says: whose surface certainly touches
/// nothing opaque, so that each opaque component is inside the mesh or outside.
template <class Pair, class IsFree, class Use>
[[nodiscard]] Result<void> forEnclosed(HostEngine& engine, const Batch& batch, std::vector<Pair>& pairs,
                                       const IsFree& isFree, const Use& use) {
    constexpr double kCoarse = 1e300; // mm^3: what cells and bricks say is mostly enough
    constexpr double kFine = 1e-3;
    std::vector<Pair*> open;
    for (Pair& pair : pairs) {
        if (isFree(pair)) {
            open.push_back(&pair);
        }
    }
    for (const double tolerance : {kCoarse, kFine}) {
        std::vector<BatchItem> items;
        for (const Pair* pair : open) {
            items.push_back(batch.items[pair->item]);
            items.back().world_from_object = items.back().world_from_object.subspan(pair->pose, 1);
        }
        Batch asked = batch;
        asked.items = items;
        const Result<OverlapAnswer> answer = engine.ask(Overlap{.tolerance = tolerance}, asked);
        VOXTACT_TRY(answer);
        std::vector<Pair*> left;
        for (std::size_t i = 0; i < open.size(); ++i) {
            const Containment inside = answer->pairs[i].inside;
            if (inside == Containment::Undecided && tolerance == kCoarse) {
                left.push_back(open[i]);
            } else {
                use(*open[i], inside);
            }
        }
        open = std::move(left);
    }
    return {};
}

} // namespace voxtact::cpu
