// SPDX-License-Identifier: MIT
#include "app/chunks/chunk_cut.h"

#include <algorithm>

namespace voxtact::app {

ChunkCut::ChunkCut(std::vector<std::uint64_t> groupRows, std::uint64_t most)
    : groupRows_(std::move(groupRows)), firstChunks_{0}, most_(most) {
    for (const std::uint64_t rows : groupRows_) {
        firstChunks_.push_back(firstChunks_.back() + rows / most_ + (rows % most_ > 0 ? 1 : 0));
        rows_ += rows;
    }
}

ChunkRange ChunkCut::at(std::uint64_t number) const {
    // The last group that begins no later: those without rows have the same first chunk as the next one.
    const auto after = std::upper_bound(firstChunks_.begin(), firstChunks_.end(), number);
    const auto group = static_cast<std::size_t>(after - firstChunks_.begin()) - 1;
    const std::uint64_t first = (number - firstChunks_[group]) * most_;
    return {number, static_cast<std::uint32_t>(group), first, std::min(most_, groupRows_[group] - first)};
}

} // namespace voxtact::app
