// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <functional>

namespace voxtact::view {

/// Returns a volume of fewer voxels in the same position: each is the mean of a block of `factor` voxels along each
/// axis (for whole numbers rounded), at the block's centre. Structures thinner than a block may vanish. Blocks at the
/// far faces may be incomplete: their means use the remaining voxels. An axis with fewer voxels than two blocks stays.
/// `tell` receives the share that is done, and cancels by returning false. Refuses a factor below 2.
[[nodiscard]] Result<VolumeData> coarser(const VolumeData& volume, std::uint32_t factor,
                                         const std::function<bool(double)>& tell = {});

} // namespace voxtact::view
