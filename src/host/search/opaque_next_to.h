// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/pair_at.h"

namespace voxtact::cpu {

/// Returns the opaque point within what single precision rounds off a witness point of a touch, or the given one where
/// there is none in its cell. World mm.
[[nodiscard]] Vec3 opaqueNextTo(const PairAt& at, const Vec3& witness);

} // namespace voxtact::cpu
