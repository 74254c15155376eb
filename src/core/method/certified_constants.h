// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/recentre.h"
#include "core/transfer/opaque_numbers.h"
#include "exact/pair_setup.h"
#include "exact/shared.h"
#include "voxtact/data.h"

namespace voxtact {

/// Constants of a grid for all pairs of the projection `certified`.
[[nodiscard]] shader::PairGrid pairGrid(const Grid& grid, const Mat4& texture_from_world) noexcept;

/// Inputs of that projection (src/exact/certified.h), computed in double and rounded to float once, so device and host
/// use the same numbers.
[[nodiscard]] shader::CertifiedPair certifiedPair(const shader::PairGrid& grid, const Mat4& world_from_object,
                                                  const MeshOrigin& origin = {}) noexcept;

/// Returns the map from stored values to entries, and the constants of an item. storedUnit is 0.
[[nodiscard]] shader::CertifiedItem certifiedItem(const Grid& grid, const OpaqueNumbers& opaque,
                                                  double resolution) noexcept;

} // namespace voxtact
