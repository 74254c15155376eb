// SPDX-License-Identifier: MIT
#pragma once

#include "host/plan/plan_scene.h"

namespace voxtact::cpu {

/// Finds the entries of a scene that has a grid of directions, and leaves out those beyond the task's limits.
[[nodiscard]] Result<void> findEntries(PlanScene& scene, Workers& workers, PlanAnswer& answer);

/// Calls `visit(rhombus, i, j, which, triangle)` for the triangles whose corners all have an entry; `triangle`: numbers
/// of directions.
template <class Visit> void forEntryTriangles(const PlanScene& scene, const Visit& visit) {
    const std::uint32_t side = scene.grid.side();
    for (std::uint32_t rhombus = 0; rhombus < DirectionGrid::kRhombi; ++rhombus) {
        for (std::uint32_t i = 0; i < side; ++i) {
            for (std::uint32_t j = 0; j < side; ++j) {
                const auto both = scene.grid.triangles(rhombus, i, j);
                for (std::uint32_t which = 0; which < both.size(); ++which) {
                    const auto& [a, b, c] = both[which];
                    if (scene.entries[a].isThere && scene.entries[b].isThere && scene.entries[c].isThere) {
                        visit(rhombus, i, j, which, both[which]);
                    }
                }
            }
        }
    }
}

} // namespace voxtact::cpu
