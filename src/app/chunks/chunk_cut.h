// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace voxtact::app {

/// Rows of a run that are done at a time: neighbours of one group.
struct ChunkRange {
    std::uint64_t number = 0; ///< of the chunk in the run
    std::uint32_t group = 0;
    std::uint64_t first = 0; ///< row of the group
    std::uint64_t count = 0;
};

/// How a run is cut: its rows are in groups, each about one volume, and a chunk has so many rows of one group, the last
/// one of a group maybe fewer. It depends on the run alone, not on who does how much of it.
class ChunkCut {
  public:
    /// `most` rows a chunk; at least 1.
    ChunkCut(std::vector<std::uint64_t> groupRows, std::uint64_t most);

    [[nodiscard]] std::uint64_t chunks() const noexcept { return firstChunks_.back(); }
    [[nodiscard]] std::uint64_t rows() const noexcept { return rows_; }
    /// The chunk of this number, which must be below chunks().
    [[nodiscard]] ChunkRange at(std::uint64_t number) const;

  private:
    std::vector<std::uint64_t> groupRows_;
    std::vector<std::uint64_t> firstChunks_; ///< of each group, and one behind the last
    std::uint64_t most_;
    std::uint64_t rows_ = 0;
};

} // namespace voxtact::app
