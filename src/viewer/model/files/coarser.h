// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <functional>

namespace voxtact::view {

/// A volume of fewer voxels in the same place: each is the mean of a block of `factor` voxels along each axis, of whole
/// numbers the nearest one, and its centre is the block's. What is thinner than a block may vanish. Blocks at the far
/// faces may be cut off there: those are the means of what is left of them. An axis with fewer voxels than two blocks
/// stays as it is. `tell` is called with the share that is done, and ends it with Cancelled where it returns false.
/// Refuses a factor below 2.
[[nodiscard]] Result<VolumeData> coarser(const VolumeData& volume, std::uint32_t factor,
                                         const std::function<bool(double)>& tell = {});

} // namespace voxtact::view
