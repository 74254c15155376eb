// SPDX-License-Identifier: MIT
#pragma once

#include "host/count/kernel.h"
#include "host/count/occupancy.h"
#include "host/count/occupancy_cache.h"
#include "host/thread_pool.h"
#include "voxtact/cpu.h"

#include <span>

namespace voxtact::cpu {

using Occupancies = OccupancyCache<Occupancy, 1>;

/// State that the threads of a detector keep between calls: one scratch per thread of the pool.
struct Workshop {
    ThreadPool& pool;
    std::span<const ScratchPointer> scratches;
};

/// The answers of a checked batch in the projections that have samples: view, two-view, dominant-axis. The results of a
/// cancelled call are undefined.
[[nodiscard]] BatchAnswer runCounts(const Batch& batch, const Cancellation& cancel, std::uint32_t pairs,
                                    const Count& desc, const Workshop& workshop, Occupancies& occupancies);

} // namespace voxtact::cpu
