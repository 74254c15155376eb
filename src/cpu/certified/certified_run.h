// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/certified/certified_occupancy.h"
#include "cpu/raster/occupancy_cache.h"
#include "cpu/thread_pool.h"
#include "voxtact/cpu.h"

namespace voxtact::cpu {

using CertifiedOccupancies = OccupancyCache<CertifiedOccupancy, 2>;

/// The answers of a checked batch in the projection `conservative`.
[[nodiscard]] BatchAnswer runCertified(const Batch& batch, std::uint32_t pairs, const DetectorDesc& desc,
                                       ThreadPool& pool, CertifiedOccupancies& occupancies);

} // namespace voxtact::cpu
