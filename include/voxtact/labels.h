// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <vector>

namespace voxtact {

/// A label map: which structure each voxel belongs to. Looked up at the nearest voxel, never interpolated; outside of
/// the map's own grid the label is 0.
struct LabelData {
    Grid grid;                          ///< where its voxels are
    std::vector<std::uint16_t> indices; ///< of each voxel, x fastest: the number of its label in `values`
    std::vector<std::int32_t> values;   ///< the labels, ascending, each once; 0 is always among them
};

/// Refuses what checkVolume() refuses, float voxels that are not whole numbers within +-2^24, and more than 65536
/// different labels (LimitExceeded). O(voxels + the labels' range).
[[nodiscard]] VOXTACT_API Result<LabelData> makeLabels(const VolumeView& volume);

/// Number of the label of a world point in `values`; that of 0 outside of the grid. The voxel along an axis with n of
/// them is floor(n * texture coordinate): half way between two centres it is the upper one, and at 1 the last one.
/// Expects what makeLabels() returns.
[[nodiscard]] VOXTACT_API std::uint32_t labelAt(const LabelData& labels, const Vec3& world) noexcept;

} // namespace voxtact
