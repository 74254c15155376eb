// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/cancel.h"
#include "cpu/certified/certified_occupancy.h"
#include "cpu/raster/occupancy_cache.h"
#include "cpu/thread_pool.h"
#include "voxtact/cpu.h"

namespace voxtact::cpu {

using CertifiedOccupancies = OccupancyCache<CertifiedOccupancy, 2>;

/// The answers of a checked batch in the projection `conservative`. What they say of a call that is cancelled means
/// nothing.
[[nodiscard]] BatchAnswer runCertified(const Batch& batch, const Cancellation& cancel, std::uint32_t pairs,
                                       const DetectorDesc& desc, ThreadPool& pool, CertifiedOccupancies& occupancies);

} // namespace voxtact::cpu
