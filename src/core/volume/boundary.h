// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <vector>

namespace voxtact {

/// Returns the scalars that a coordinate clamped to the image's faces can sample: the corner ranges of all 2x2 cells of
/// voxels on a face, merged into disjoint ascending ranges. Expects a volume that checkVolume() accepts. If none of
/// them may be opaque, clamping gives the same fragments as the range test (paper, section 5).
[[nodiscard]] std::vector<ValueRange> boundaryRanges(const VolumeView& volume);

} // namespace voxtact
