// SPDX-License-Identifier: MIT
#include "vulkan/memory/block_ranges.h"

#include <iterator>

namespace voxtact {

BlockRanges::BlockRanges(std::uint64_t size) {
    ranges_.try_emplace(0).first->second.size = size;
    free_.emplace(size, 0);
}

void BlockRanges::resize(Ranges::iterator range, std::uint64_t size) noexcept {
    FreeRanges::node_type place = free_.extract({range->second.size, range->first});
    place.value().first = size;
    free_.insert(std::move(place));
    range->second.size = size;
}

void BlockRanges::cut(std::uint64_t begin, std::uint64_t size) {
    const auto range = ranges_.find(begin);
    const std::uint64_t rest = range->second.size - size;
    if (size == 0 || rest == 0) {
        return;
    }
    Ranges second;
    second.try_emplace(begin + size).first->second.size = rest;
    FreeRanges place{{rest, begin + size}};
    // Nothing throws from here on.
    resize(range, size);
    ranges_.merge(second);
    free_.merge(place);
}

std::optional<std::uint64_t> BlockRanges::take(std::uint64_t size, std::uint64_t alignment) {
    for (auto found = free_.lower_bound({size, 0}); found != free_.end(); ++found) {
        const auto [room, begin] = *found;
        const std::uint64_t aligned = (begin + alignment - 1) / alignment * alignment;
        if (aligned - begin > room - size) {
            continue;
        }
        cut(begin, aligned - begin);
        cut(aligned, size);
        ranges_.find(aligned)->second.spare = free_.extract({size, aligned});
        ++taken_;
        return aligned;
    }
    return std::nullopt;
}

void BlockRanges::giveBack(std::uint64_t begin) noexcept {
    auto range = ranges_.find(begin);
    FreeRanges::node_type place = std::move(range->second.spare);
    --taken_;
    if (const auto next = std::next(range); next != ranges_.end() && next->second.free()) {
        free_.erase({next->second.size, next->first});
        range->second.size += next->second.size;
        ranges_.erase(next);
    }
    if (range != ranges_.begin() && std::prev(range)->second.free()) {
        const auto before = std::prev(range);
        resize(before, before->second.size + range->second.size);
        ranges_.erase(range);
        return;
    }
    place.value() = {range->second.size, begin};
    free_.insert(std::move(place));
}

} // namespace voxtact
