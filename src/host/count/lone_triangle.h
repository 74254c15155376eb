// SPDX-License-Identifier: MIT
#pragma once

#include "exact/exact.h"
#include "host/count/row_spans.h"
#include "host/count/scratch.h"

#include <cstddef>

namespace voxtact::cpu {

/// A triangle through exactVertex(), dominantProject() where there is no camera, exactClip() and exactSetUp(); returns
/// how many triangles came of it.
[[nodiscard]] std::size_t setUpLone(const PairJob& job, const LoneTriangle& lone,
                                    shader::ExactTriangle (&out)[EXACT_MAX_CORNERS]);

/// What the fragments of a triangle meet: certain to be opaque (and in the image, where that is tested), clear, or
/// not known.
[[nodiscard]] BrickClass triangleClass(const PairJob& job, const shader::ExactTriangle& triangle) noexcept;

/// Whether a cluster certainly has no survivor: nothing of it is in the view volume, or it meets nothing opaque.
[[nodiscard]] bool isClear(const PairJob& job, std::size_t cluster) noexcept;

} // namespace voxtact::cpu
