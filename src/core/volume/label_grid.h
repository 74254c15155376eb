// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <span>
#include <string>

/// Checks the label maps of a question about labels.
namespace voxtact {

/// Refuses a label map that is not on a volume's grid, and states the difference. The tolerance is a ten-thousandth of
/// a voxel, because files may differ in the last digits. `which` begins the text.
[[nodiscard]] Result<void> checkLabelGrid(const Grid& labels, const Grid& volume, const std::string& which);

/// The label map on a volume's grid, of which its own is a part: the same directions and spacing, an offset of whole
/// voxels, to a thousandth of one. Voxels outside of that part have the label 0. Refuses other grids like
/// checkLabelGrid().
[[nodiscard]] Result<LabelData> labelsOnGrid(const LabelData& labels, const Grid& volume, const std::string& which);

/// Refuses more than kMaxMeasuredLabels labels.
[[nodiscard]] Result<void> checkMeasuredLabels(std::span<const std::int32_t> labels);
/// Refuses an item without a label map. `which` begins the text.
[[nodiscard]] Error noLabelsToMeasure(const std::string& which);

} // namespace voxtact
