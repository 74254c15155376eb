// SPDX-License-Identifier: MIT
#pragma once

#include "host/area/cell_part.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// Divisible parts: the part with the largest gain first; of equal ones, the earliest.
class OpenParts {
  public:
    struct Open {
        CellPart part;
        PartArea area;
    };

    /// Maximum number of removals: of the parts added before the first removal, it keeps at most twice as many.
    explicit OpenParts(std::uint64_t most) : most_(std::max<std::uint64_t>(most, 1)) {}

    void add(const CellPart& part, const PartArea& area) {
        if (!isHeap_ && order_.size() / 2 >= most_) {
            keepBest();
        }
        const auto place = static_cast<std::uint32_t>(free_.empty() ? parts_.size() : free_.back());
        if (free_.empty()) {
            parts_.push_back({part, area});
        } else {
            parts_[place] = {part, area};
            free_.pop_back();
        }
        order_.push_back({area.gain, numbered_++, place});
        if (isHeap_) {
            std::ranges::push_heap(order_, isWorse);
        }
    }
    [[nodiscard]] bool empty() const noexcept { return order_.empty(); }
    /// Expects that there is one.
    [[nodiscard]] Open takeBest() {
        if (!isHeap_) {
            std::ranges::make_heap(order_, isWorse);
            isHeap_ = true;
        }
        std::ranges::pop_heap(order_, isWorse);
        const std::uint32_t place = order_.back().place;
        free_.push_back(place);
        order_.pop_back();
        return parts_[place];
    }

  private:
    struct Ordered {
        double gain = 0;
        std::uint64_t number = 0;
        std::uint32_t place = 0; ///< in `parts_`
    };
    static bool isWorse(const Ordered& a, const Ordered& b) noexcept {
        return a.gain != b.gain ? a.gain < b.gain : a.number > b.number;
    }
    void keepBest() {
        const auto end = order_.begin() + static_cast<std::ptrdiff_t>(most_);
        std::ranges::nth_element(order_, end, [](const Ordered& a, const Ordered& b) { return isWorse(b, a); });
        std::for_each(end, order_.end(), [this](const Ordered& one) { free_.push_back(one.place); });
        order_.erase(end, order_.end());
    }

    std::vector<Ordered> order_;
    std::vector<Open> parts_;
    std::vector<std::uint32_t> free_; ///< places of `parts_`
    std::uint64_t most_;
    std::uint64_t numbered_ = 0;
    bool isHeap_ = false;
};

} // namespace voxtact::cpu
