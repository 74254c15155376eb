// SPDX-License-Identifier: MIT
#pragma once

#include "pair_setup.h"
#include "shared.h"
#include "voxtact/data.h"
#include "voxtact/motion.h"

#include <array>

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

/// Refuses a margin that is not a number from 0 to 1,000,000 mm.
[[nodiscard]] Result<void> checkMargin(double margin);

/// Refuses a pose tolerance whose distance is not a number from 0 on, or whose angle is outside of 0 to 180 degrees.
[[nodiscard]] Result<void> checkTolerance(const PoseTolerance& tolerance);

/// The same on a device, whose distances are no more than 1,000,000 mm.
[[nodiscard]] Result<void> checkDeviceTolerance(const PoseTolerance& tolerance);

/// Refuses a resolution of a motion that is not a number from 1e-6 mm on, and an interpolation that there is not.
[[nodiscard]] Result<void> checkMotion(const MotionSearch& search);

/// Refuses a tolerance of a clearance that is not a number from 1e-6 mm on.
[[nodiscard]] Result<void> checkTolerance(double tolerance);
/// Refuses a maximum of a clearance, mm, that is not above 0.
[[nodiscard]] Result<void> checkMaximum(double maximum);

/// Of a voxel, mm: the unit of flat space.
[[nodiscard]] double longestSide(const Grid& grid) noexcept;

/// How far a margin, mm, reaches from a point, in voxels along each axis.
[[nodiscard]] std::array<double, 3> voxelsOfMargin(const Grid& grid, double margin) noexcept;

/// An item that is asked what is within a margin, mm, more than 0: marginOf() of shaders/certified_margin.h reads it.
[[nodiscard]] shader::CertifiedItem withMargin(shader::CertifiedItem item, const Grid& grid, double margin) noexcept;

/// The same for what may be turned, too (TURN there), 0 among the distances: `grow` is then that of a margin of 1,
/// flat.
[[nodiscard]] shader::CertifiedItem withTolerance(shader::CertifiedItem item, const Grid& grid,
                                                  double distance) noexcept;

/// An item that is asked how near what is opaque is: its `resolution` is then what of the tolerance, mm, the search may
/// leave, flat, and what marginOf() reads is that of a margin of 1.
[[nodiscard]] shader::CertifiedItem withClearance(shader::CertifiedItem item, const Grid& grid,
                                                  double tolerance) noexcept;

/// An item all of which is opaque, whatever its table says: what is no number is not.
[[nodiscard]] shader::CertifiedItem withAnyOpacity(shader::CertifiedItem item) noexcept;

} // namespace voxtact
