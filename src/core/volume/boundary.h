// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <vector>

namespace voxtact {

/// The scalars that a coordinate clamped to the image's faces can sample: for every 2x2 cell of voxels on a face the
/// range of its corners, merged into disjoint ascending ranges. Expects a volume that checkVolume() accepts.
/// When none of them may be opaque, clamping the coordinate gives the same fragments as the range test (paper,
/// section 5).
[[nodiscard]] std::vector<ValueRange> boundaryRanges(const VolumeView& volume);

} // namespace voxtact
