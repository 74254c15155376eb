// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/recentre.h"
#include "core/transfer/opaque_numbers.h"
#include "exact/pair_setup.h"
#include "exact/shared.h"
#include "voxtact/data.h"

namespace voxtact {

/// What of a grid is the same for all pairs of the projection `certified`.
[[nodiscard]] shader::PairGrid pairGrid(const Grid& grid, const Mat4& texture_from_world) noexcept;

/// What that projection starts from (src/exact/certified.h), made in double and rounded to float once, so that device
/// and host see the same numbers.
[[nodiscard]] shader::CertifiedPair certifiedPair(const shader::PairGrid& grid, const Mat4& world_from_object,
                                                  const MeshOrigin& origin = {}) noexcept;

/// Stored value -> entry, and what is the same for all pairs of an item. storedUnit is 0.
[[nodiscard]] shader::CertifiedItem certifiedItem(const Grid& grid, const OpaqueNumbers& opaque,
                                                  double resolution) noexcept;

} // namespace voxtact
