// SPDX-License-Identifier: MIT
#pragma once

#include "host/cancel.h"
#include "host/count/occupancy_cache.h"
#include "host/thread_pool.h"
#include "host/touch/cells/certified_occupancy.h"
#include "voxtact/cpu.h"

namespace voxtact::cpu {

using CertifiedOccupancies = OccupancyCache<CertifiedOccupancy, 2>;

/// The answers of a checked batch in the projection `certified`. The results of a cancelled call are undefined.
[[nodiscard]] BatchAnswer runCertified(const Batch& batch, const Cancellation& cancel, std::uint32_t pairs,
                                       const Count& desc, ThreadPool& pool, CertifiedOccupancies& occupancies);

} // namespace voxtact::cpu
