// SPDX-License-Identifier: MIT
#pragma once

#include "core/pair_transform.h"
#include "gpu/context_impl.h"
#include "voxtact/detector.h"

namespace voxtact {

/// Refuses what cmdDetect() cannot record: null objects, objects of another context, poses and cameras that are not
/// finite or not affine, a singular camera, a viewport of 0 or beyond the device's, a threshold outside [0,1].
/// Returns the number of pairs.
[[nodiscard]] Result<std::uint32_t> checkBatch(const ContextImpl& context, const Batch& batch);

/// Sample -> normalised scalar of an item, and the threshold. The filter says what a sample is.
[[nodiscard]] shader::ItemConstants itemConstants(const BatchItem& item, Filter filter, double threshold) noexcept;

/// Whether a 32-bit counter could overflow: it cannot while every triangle could cover every pixel and still fit.
[[nodiscard]] bool needsCarry(const Batch& batch, const BatchItem& item) noexcept;

} // namespace voxtact
