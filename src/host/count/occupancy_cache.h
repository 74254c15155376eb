// SPDX-License-Identifier: MIT
#pragma once

#include "host/scene/scene_impl.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace voxtact::cpu {

/// Most recently used occupancies. `Made` is built from a volume, a transfer function and numbers.
template <class Made, std::size_t Numbers> class OccupancyCache {
  public:
    template <class... Values>
    [[nodiscard]] std::shared_ptr<const Made> get(const VolumeImpl& volume, const TransferFunctionImpl& function,
                                                  Values... values) {
        const std::array<double, Numbers> numbers{values...};
        const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
            return entry.volume == volume.id && entry.function == function.id && entry.numbers == numbers;
        });
        if (found != entries_.end()) {
            std::rotate(found, found + 1, entries_.end());
            return entries_.back().made;
        }
        auto made = std::make_shared<const Made>(volume, function, values...);
        if (entries_.size() == kMost) {
            entries_.erase(entries_.begin());
        }
        entries_.push_back({volume.id, function.id, numbers, made});
        return made;
    }

  private:
    static constexpr std::size_t kMost = 16;

    struct Entry {
        std::uint64_t volume;
        std::uint64_t function;
        std::array<double, Numbers> numbers;
        std::shared_ptr<const Made> made;
    };
    std::vector<Entry> entries_; ///< the one used last is at the end
};

} // namespace voxtact::cpu
