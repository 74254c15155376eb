// SPDX-License-Identifier: MIT
#pragma once

#include "exact/exact.h"
#include "host/count/row_spans.h"
#include "host/count/scratch.h"

#include <cstddef>

namespace voxtact::cpu {

/// Applies exactVertex(), dominantProject() (without a camera), exactClip() and exactSetUp() to a triangle; returns the
/// number of resulting triangles.
[[nodiscard]] std::size_t setUpLone(const PairJob& job, const LoneTriangle& lone,
                                    shader::ExactTriangle (&out)[EXACT_MAX_CORNERS]);

/// Classification of a triangle's fragments: certainly opaque (and in the image, if tested), certainly transparent, or
/// unknown.
[[nodiscard]] BrickClass triangleClass(const PairJob& job, const shader::ExactTriangle& triangle) noexcept;

/// Returns true if a cluster certainly has no passing fragment: it is outside the view volume, or meets nothing opaque.
[[nodiscard]] bool isClear(const PairJob& job, std::size_t cluster) noexcept;

} // namespace voxtact::cpu
