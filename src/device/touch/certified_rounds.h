// SPDX-License-Identifier: MIT
#pragma once

#include "exact/shared.h"
#include "voxtact/detector.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

/// How a batch of the projection `certified` is cut into rounds, so that no dispatch of one has too much to do.
namespace voxtact {

/// Most of a round.
struct RoundLimits {
    std::uint32_t clusters = 0; ///< of pairs
    std::uint32_t pairs = 0;
    double looks = 0; ///< at bricks and cells of large triangles, unless a cluster of a pair has more
};

[[nodiscard]] constexpr std::uint32_t clustersOfRound(std::uint32_t queueRoom, bool stopAtFirst) noexcept {
    // A count has as many cells as the mesh has in opaque matter; a yes or no is found before most of them are.
    return stopAtFirst ? queueRoom : queueRoom / 4;
}
[[nodiscard]] constexpr double looksOfRound(std::uint32_t queueRoom) noexcept {
    return std::min(queueRoom * double{VOXTACT_LOOKS_OF_CLUSTER}, VOXTACT_MOST_LOOKS);
}

/// What an item asks for at most.
struct MeshLooks {
    std::uint32_t pairs = 0;
    std::uint32_t clusters = 0;
    /// At its large triangles, by the clusters before each number; empty where that is not known.
    std::span<const double> before{};
    double scale = 1; ///< what these are to be multiplied by
    double most = 0;  ///< of one cluster, whatever the others say

    [[nodiscard]] double of(std::uint32_t first, std::uint32_t end) const noexcept {
        return before.empty() ? 0 : std::min(scale * (before[end] - before[first]), most * (end - first));
    }
};

/// Clusters of a round: of a mesh whose looks are not known no more than every device has room for, since only they
/// bound what its triangles ask for.
[[nodiscard]] std::uint32_t clustersOf(const MeshLooks& looks, std::uint32_t queueRoom, bool stopAtFirst) noexcept;

/// Of an item whose mesh is on the device.
[[nodiscard]] MeshLooks meshLooks(const BatchItem& item) noexcept;

/// The pairs of an item, and the clusters of each, that one round has.
struct Round {
    std::uint32_t firstPair = 0;
    std::uint32_t pairs = 0;
    std::uint32_t firstCluster = 0;
    std::uint32_t endCluster = 0;
};

/// The clusters from `first` on that one round can have, of one pair: at least one.
[[nodiscard]] inline std::uint32_t endOfRound(const MeshLooks& mesh, const RoundLimits& limits,
                                              std::uint32_t first) noexcept {
    std::uint32_t most = first + std::min(limits.clusters, mesh.clusters - first);
    std::uint32_t end = first + 1;
    while (end < most) { // by halves: what is before a cluster only grows
        const std::uint32_t middle = most - (most - end) / 2;
        if (mesh.of(first, middle) <= limits.looks) {
            end = middle;
        } else {
            most = middle - 1;
        }
    }
    return end;
}

/// How an item is cut into rounds: so many pairs at once if each round has all of the mesh, else one.
struct RoundCut {
    MeshLooks mesh;
    RoundLimits limits;

    [[nodiscard]] bool hasWholeMesh() const noexcept {
        return mesh.clusters <= limits.clusters && mesh.of(0, mesh.clusters) <= limits.looks;
    }
    [[nodiscard]] std::uint32_t pairsAtOnce() const noexcept {
        if (!hasWholeMesh()) {
            return 1;
        }
        const double looks = mesh.of(0, mesh.clusters);
        const std::uint32_t atOnce = std::min(limits.clusters / mesh.clusters, limits.pairs);
        return looks * atOnce <= limits.looks ? atOnce : static_cast<std::uint32_t>(limits.looks / looks);
    }
};

/// Calls `record` for each round of one pair's clusters, in order, with the first and the end.
template <class Record> void eachClusterRound(const RoundCut& cut, Record&& record) {
    const bool wholeMesh = cut.hasWholeMesh();
    for (std::uint32_t cluster = 0, end = 0; cluster < cut.mesh.clusters; cluster = end) {
        end = wholeMesh ? cut.mesh.clusters : endOfRound(cut.mesh, cut.limits, cluster);
        record(cluster, end);
    }
}

/// Calls `record` for each round of an item, in order: each pair and cluster is in one of them.
template <class Record> void eachRound(const RoundCut& cut, Record&& record) {
    const std::uint32_t atOnce = cut.pairsAtOnce();
    for (std::uint32_t pair = 0; pair < cut.mesh.pairs; pair += std::min(atOnce, cut.mesh.pairs - pair)) {
        eachClusterRound(cut, [&](std::uint32_t first, std::uint32_t end) {
            record(Round{pair, std::min(atOnce, cut.mesh.pairs - pair), first, end});
        });
    }
}

/// How many rounds an item has; `most` where there are more.
[[nodiscard]] inline std::uint64_t roundsOf(const RoundCut& cut, std::uint64_t most) noexcept {
    if (cut.mesh.pairs == 0) {
        return 0;
    }
    const std::uint64_t times = (cut.mesh.pairs - 1) / cut.pairsAtOnce() + std::uint64_t{1};
    std::uint64_t rounds = 0;
    eachClusterRound(cut, [&](std::uint32_t, std::uint32_t) { ++rounds; });
    return std::min(rounds * times, most);
}

} // namespace voxtact
