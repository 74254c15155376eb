// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/occupancy.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace voxtact::cpu {

/// The occupancies that were asked for last.
class OccupancyCache {
  public:
    [[nodiscard]] std::shared_ptr<const Occupancy> get(const VolumeImpl& volume, const TransferFunctionImpl& function,
                                                       double threshold);

  private:
    struct Entry {
        std::uint64_t volume;
        std::uint64_t function;
        double threshold;
        std::shared_ptr<const Occupancy> occupancy;
    };
    std::vector<Entry> entries_; ///< the one used last is at the end
};

} // namespace voxtact::cpu
