// SPDX-License-Identifier: MIT
#pragma once

#include "pair_setup.h"
#include "shared.h"
#include "voxtact/data.h"

namespace voxtact {

/// Refuses a resolution outside of 2^-12 to 1 voxel, and NaN.
[[nodiscard]] Result<void> checkResolution(double resolution);

/// What of a grid is the same for all pairs of the projection `conservative`.
[[nodiscard]] shader::PairGrid pairGrid(const Grid& grid, const Mat4& texture_from_world) noexcept;

/// What that projection starts from (shaders/certified.h), made in double and rounded to float once, so that device and
/// host see the same numbers.
[[nodiscard]] shader::CertifiedPair certifiedPair(const shader::PairGrid& grid, const Mat4& world_from_object) noexcept;

/// Stored value -> entry coordinate, and what is the same for all pairs of an item. value = slope * stored + intercept.
/// storedUnit is 0.
[[nodiscard]] shader::CertifiedItem certifiedItem(const Grid& grid, double slope, double intercept,
                                                  const ValueRange& domain, std::size_t tableSize, double threshold,
                                                  double resolution) noexcept;

} // namespace voxtact
