// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/pair_at.h"

namespace voxtact::cpu {

/// Returns the opaque point within single-precision rounding of a witness point of a touch, or the given point if its
/// cell has none. World mm.
[[nodiscard]] Vec3 opaqueNextTo(const PairAt& at, const Vec3& witness);

} // namespace voxtact::cpu
