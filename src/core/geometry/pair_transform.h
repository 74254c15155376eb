// SPDX-License-Identifier: MIT
#pragma once

#include "exact/shared.h"
#include "voxtact/data.h"

namespace voxtact {

/// Matrices of a pair for all counting methods. Products are computed in double and rounded to float once, so device
/// and host use the same numbers.
[[nodiscard]] shader::PairTransform pairTransform(const Mat4& clip_from_world, const Mat4& world_from_object,
                                                  const Mat4& texture_from_world) noexcept;

/// Stored value -> normalised scalar, and the threshold. value = valueSlope * stored + valueIntercept, where stored is
/// what the sampler returns (a texel in [0,1]) or, for exact filtering, the integer behind it. storedUnit is 0.
[[nodiscard]] shader::ItemConstants itemConstants(double valueSlope, double valueIntercept, const ValueRange& domain,
                                                  double threshold) noexcept;
/// Returns true if single precision represents them: none is infinite, and the scale is not 0.
[[nodiscard]] bool areSingle(const shader::ItemConstants& constants) noexcept;

} // namespace voxtact
