// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/try.h"
#include "host/host_engine.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace voxtact::cpu {

/// Tests for an opaque region inside the mesh of a pair.
struct Enclosed {
    Verdict verdict = Verdict::No;
    std::optional<Vec3> point; ///< for a yes: certainly opaque and inside, world mm; empty if rounding hides it
};

/// Refuses meshes without an inside.
[[nodiscard]] Result<void> checkSolids(HostEngineImpl& impl, const Batch& batch);

/// One for each pair of a batch. `tolerance`: of the overlap that decides, mm^3.
[[nodiscard]] Result<std::vector<Enclosed>> enclosedIn(HostEngineImpl& impl, const Batch& batch, double tolerance);

/// Calls `use(pair, enclosed)` for the pairs of a batch with `isFree(pair)`: their surface does not certainly touch.
template <class Pair, class IsFree, class Use>
[[nodiscard]] Result<void> forEnclosed(HostEngineImpl& impl, const Batch& batch, std::vector<Pair>& pairs,
                                       const IsFree& isFree, const Use& use) {
    constexpr double kCoarse = 1e300; // mm^3: the ranges of cells and bricks mostly decide
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
        const Result<std::vector<Enclosed>> enclosed = enclosedIn(impl, asked, tolerance);
        VOXTACT_TRY(enclosed);
        std::vector<Pair*> left;
        for (std::size_t i = 0; i < open.size(); ++i) {
            const Enclosed& one = (*enclosed)[i];
            if (one.verdict == Verdict::Undecided && tolerance == kCoarse) {
                left.push_back(open[i]);
            } else {
                use(*open[i], one);
            }
        }
        open = std::move(left);
    }
    return {};
}

} // namespace voxtact::cpu
