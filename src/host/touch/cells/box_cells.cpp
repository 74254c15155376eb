// SPDX-License-Identifier: MIT
#include "host/touch/cells/box_cells.h"
#include "core/geometry/clusters.h"

#include <span>

namespace voxtact::cpu {

BoxCells::BoxCells(const shader::CertifiedItem& item, const shader::CertifiedPair& pair,
                   const ClusterTree& tree) noexcept
    : pair_(pair), last_{static_cast<float>(item.sizeX - 1), static_cast<float>(item.sizeY - 1),
                         static_cast<float>(item.sizeZ - 1)} {
    const std::span<const RunBox> top = tree.boxes(tree.levels() - 1);
    RunBox all = top.front();
    for (const RunBox& box : top) {
        grow(all, box);
    }
    const shader::CertifiedBounds bounds =
        shader::certifiedBoxBounds(item, pair, {all.lo[0], all.lo[1], all.lo[2], all.hi[0], all.hi[1], all.hi[2]});
    // The radius of an inner box is at most that of this one, up to rounding.
    constexpr float kRounding = 1 + 0x1p-20F;
    delta_ = bounds.delta * kRounding;
    usable_ = delta_ <= CERTIFIED_MOST_DELTA;
}

} // namespace voxtact::cpu
