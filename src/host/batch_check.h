// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/cpu.h"

namespace voxtact::cpu {

/// Refuses null objects, poses and cameras that are not finite or not affine, a singular camera, a viewport of 0 or
/// beyond kMaxViewport, a threshold outside [0,1]. The camera counts only where the projection has one. Returns the
/// number of pairs.
[[nodiscard]] Result<std::uint32_t> checkBatch(const Count& desc, const Batch& batch);

/// The same of a batch that is asked for what is certain of it, without a camera.
[[nodiscard]] Result<void> checkCertifiedBatch(const Batch& batch);

/// The same of an item alone.
[[nodiscard]] Result<void> checkCertifiedItem(const BatchItem& item, double threshold);

/// Refuses more than kMaxThreads.
[[nodiscard]] Result<void> checkThreads(std::uint32_t threads);

} // namespace voxtact::cpu
