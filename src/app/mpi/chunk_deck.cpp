// SPDX-License-Identifier: MIT
#include "app/mpi/chunk_deck.h"

#include <algorithm>

namespace voxtact::app {

ChunkDeck::ChunkDeck(const ChunkCut& cut, const std::vector<std::uint64_t>& chunks) : cut_(cut) {
    for (const std::uint64_t chunk : chunks) {
        const ChunkRange range = cut.at(chunk);
        Group& group = groups_[range.group];
        group.chunks.push_back(chunk);
        group.rowsLeft += range.count;
    }
}

std::optional<std::uint32_t> ChunkDeck::groupFor(int rank) const {
    const auto place = places_.find(rank);
    if (place != places_.end() && groups_.at(place->second).rowsLeft > 0) {
        return place->second;
    }
    const auto share = [](const auto& entry) {
        return static_cast<double>(entry.second.rowsLeft) / static_cast<double>(entry.second.ranks + 1);
    };
    const auto best = std::max_element(groups_.begin(), groups_.end(),
                                       [&](const auto& a, const auto& b) { return share(a) < share(b); });
    return best == groups_.end() || best->second.rowsLeft == 0 ? std::nullopt : std::optional(best->first);
}

std::optional<std::uint64_t> ChunkDeck::deal(int rank) {
    const std::optional<std::uint32_t> number = groupFor(rank);
    const auto place = places_.find(rank);
    if (place != places_.end() && number != place->second) {
        --groups_.at(place->second).ranks;
        places_.erase(place);
    }
    if (!number) {
        return std::nullopt;
    }
    Group& group = groups_.at(*number);
    if (places_.emplace(rank, *number).second) {
        ++group.ranks;
    }
    const std::uint64_t chunk = group.chunks[group.next++];
    group.rowsLeft -= cut_.at(chunk).count;
    return chunk;
}

std::optional<std::size_t> deviceOfRank(const std::vector<bool>& isGpu, int rankOnMachine) {
    std::vector<std::size_t> gpus;
    for (std::size_t i = 0; i < isGpu.size(); ++i) {
        if (isGpu[i]) {
            gpus.push_back(i);
        }
    }
    return gpus.size() < 2 ? std::nullopt : std::optional(gpus[static_cast<std::size_t>(rankOnMachine) % gpus.size()]);
}

} // namespace voxtact::app
