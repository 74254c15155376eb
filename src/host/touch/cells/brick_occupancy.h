// SPDX-License-Identifier: MIT
#pragma once

#include "host/count/brick_sums.h"
#include "voxtact/cpu.h"

#include <cstdint>

namespace voxtact::cpu {

/// Finds boxes of texture space that may have an opaque sample, whatever the device's filtering: a box of bricks in
/// eight lookups. A snapshot of the volume. Thread-safety: const functions are safe from any thread.
class BrickOccupancy {
  public:
    /// `tolerance`: error of the filter in stored units, in addition to its weights: kEightBitFilterError.
    BrickOccupancy(const Volume& volume, const TransferFunction& function, double threshold, double tolerance = 0);

    /// False only where no sample of a closed box within [0,1]^3 is opaque.
    [[nodiscard]] bool mayBeOpaque(const Box& texture) const noexcept;

  private:
    std::array<std::int32_t, 3> size_{}; ///< voxels
    BrickSums<std::uint32_t> sums_;      ///< of the bricks that may
};

} // namespace voxtact::cpu
