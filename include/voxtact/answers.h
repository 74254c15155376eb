// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/export.h"
#include "voxtact/methods.h"
#include "voxtact/pair_result.h"

#include <cstdint>
#include <vector>

namespace voxtact {

/// A PairResult unpacked.
struct PairAnswer {
    std::uint32_t pair = 0;
    std::uint32_t item = 0;
    std::uint32_t pose = 0;
    bool hit = false;
    std::uint64_t count = 0; ///< survivors; 1 for a hit when the exactness is LowerBound
    Exactness exactness = Exactness::Exact;
    CountingMethod method = CountingMethod::Query;
    Projection projection = Projection::View;
};

[[nodiscard]] VOXTACT_API PairAnswer unpack(const PairResult& result) noexcept;

struct BatchAnswer {
    std::vector<PairAnswer> pairs;
    double gpuMilliseconds = 0;  ///< device time of the batch; 0 where the queue has no timestamps
    double wallMilliseconds = 0; ///< from the start of recording to the results in host memory
};

} // namespace voxtact
