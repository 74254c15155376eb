// SPDX-License-Identifier: MIT
#include "cpu/occupancy_cache.h"

#include <algorithm>

namespace voxtact::cpu {

namespace {
constexpr std::size_t kMost = 16;
}

std::shared_ptr<const Occupancy> OccupancyCache::get(const VolumeImpl& volume, const TransferFunctionImpl& function,
                                                     double threshold) {
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
        return entry.volume == volume.id && entry.function == function.id && entry.threshold == threshold;
    });
    if (found != entries_.end()) {
        std::rotate(found, found + 1, entries_.end());
        return entries_.back().occupancy;
    }
    auto made = std::make_shared<const Occupancy>(volume, function, threshold);
    if (entries_.size() == kMost) {
        entries_.erase(entries_.begin());
    }
    entries_.push_back({volume.id, function.id, threshold, made});
    return made;
}

} // namespace voxtact::cpu
