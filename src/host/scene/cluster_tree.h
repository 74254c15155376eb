// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/clusters.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace voxtact::cpu {

/// Boxes around runs of kRunTriangles triangles, around clusters, and around more and more clusters, which are near
/// each other because makeClusters() splits in half again and again. Level 0 has a box for each run, each further level
/// one for kFanOut consecutive boxes of the level below, the last level at most kFanOut.
class ClusterTree {
  public:
    static constexpr std::uint32_t kFanOut = 4;
    static constexpr std::uint32_t kRunsOfCluster = kClusterTriangles / kRunTriangles;
    static_assert(kRunsOfCluster == kFanOut, "clusters are a level of their own");

    ClusterTree() = default;
    /// `runs`: the boxes of all runs, cluster by cluster.
    explicit ClusterTree(std::vector<RunBox> runs);

    /// Calls `visit(run)` for the runs of the clusters [begin, end) in order, without those below a box that
    /// `keep(box)` is false for; run `r` is the (r % kRunsOfCluster)th of cluster r / kRunsOfCluster. Stops when
    /// `visit` returns false.
    template <class Keep, class Visit>
    void descend(std::uint32_t begin, std::uint32_t end, const Keep& keep, const Visit& visit) const {
        const auto top = static_cast<std::uint32_t>(levels_.size()) - 1;
        for (std::uint32_t node = 0; node < levels_[top].size(); ++node) {
            if (!descendNode(top, node, begin * kRunsOfCluster, end * kRunsOfCluster, keep, visit)) {
                return;
            }
        }
    }

    [[nodiscard]] std::uint32_t levels() const noexcept { return static_cast<std::uint32_t>(levels_.size()); }
    /// Returns the boxes of a level, from 0.
    [[nodiscard]] std::span<const RunBox> boxes(std::uint32_t level) const noexcept { return levels_[level]; }

  private:
    template <class Keep, class Visit>
    bool descendNode(std::uint32_t level, std::uint32_t node, std::uint32_t begin, std::uint32_t end, const Keep& keep,
                     const Visit& visit) const {
        const std::uint32_t shift = kFanOutBits * level;
        if (((node + 1) << shift) <= begin || (node << shift) >= end || !keep(levels_[level][node])) {
            return true;
        }
        if (level == 0) {
            return visit(node);
        }
        const std::uint32_t last =
            std::min((node + 1) * kFanOut, static_cast<std::uint32_t>(levels_[level - 1].size()));
        for (std::uint32_t child = node * kFanOut; child < last; ++child) {
            if (!descendNode(level - 1, child, begin, end, keep, visit)) {
                return false;
            }
        }
        return true;
    }

    static constexpr std::uint32_t kFanOutBits = 2;
    static_assert(1U << kFanOutBits == kFanOut);

    std::vector<std::vector<RunBox>> levels_;
};

} // namespace voxtact::cpu
