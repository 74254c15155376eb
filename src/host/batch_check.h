// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/cpu.h"

namespace voxtact::cpu {

/// Refuses null objects, poses and cameras that are not finite or not affine, a singular camera, a viewport of 0 or
/// beyond kMaxViewport, a threshold outside [0,1]. The camera counts only where the projection has one. Returns the
/// number of pairs.
[[nodiscard]] Result<std::uint32_t> checkBatch(const Count& desc, const Batch& batch);

/// Like checkBatch(), for certified questions, which need no camera.
[[nodiscard]] Result<void> checkCertifiedBatch(const Batch& batch);

/// Like checkBatch(), for a single item.
[[nodiscard]] Result<void> checkCertifiedItem(const BatchItem& item, double threshold);

/// Refuses more than kMaxThreads.
[[nodiscard]] Result<void> checkThreads(std::uint32_t threads);

} // namespace voxtact::cpu
