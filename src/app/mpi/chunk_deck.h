// SPDX-License-Identifier: MIT
#pragma once

#include "app/chunks/chunk_cut.h"

#include <map>
#include <optional>
#include <vector>

namespace voxtact::app {

/// The chunks of a run that are to be done, dealt to ranks one at a time: each stays with its group, whose volume it
/// has loaded, as long as there is something left of it; then it goes to the group with the most rows left for each
/// rank that is there. Thread-safety: none; one thread at a time.
class ChunkDeck {
  public:
    /// `chunks`: the numbers of those that are to be done, rising.
    ChunkDeck(const ChunkCut& cut, const std::vector<std::uint64_t>& chunks);

    /// Nothing: all are dealt.
    [[nodiscard]] std::optional<std::uint64_t> deal(int rank);

  private:
    struct Group {
        std::vector<std::uint64_t> chunks;
        std::size_t next = 0;
        std::uint64_t rowsLeft = 0;
        std::uint64_t ranks = 0; ///< that had their last chunk from here
    };
    [[nodiscard]] std::optional<std::uint32_t> groupFor(int rank) const;

    const ChunkCut& cut_;
    std::map<std::uint32_t, Group> groups_;
    std::map<int, std::uint32_t> places_; ///< the group of each rank
};

/// Which of the devices of a machine a rank is to use, of several GPUs a number of its own; nothing: it makes no
/// difference. `isGpu` says it of each device.
[[nodiscard]] std::optional<std::size_t> deviceOfRank(const std::vector<bool>& isGpu, int rankOnMachine);

} // namespace voxtact::app
