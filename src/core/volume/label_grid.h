// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <span>
#include <string>

/// Checks the label maps of a question about labels.
namespace voxtact {

[[nodiscard]] Error notOnGrid(const std::string& which);
/// Refuses a label map that is not on a volume's grid. Two files of one grid may differ in its last digits: voxels that
/// are less than a ten-thousandth of one apart are the same. `which` begins the text of a refusal.
[[nodiscard]] Result<void> checkLabelGrid(const Grid& labels, const Grid& volume, const std::string& which);

/// Refuses more than kMaxMeasuredLabels labels.
[[nodiscard]] Result<void> checkMeasuredLabels(std::span<const std::int32_t> labels);
/// Refuses an item without a label map. `which` begins the text.
[[nodiscard]] Error noLabelsToMeasure(const std::string& which);

} // namespace voxtact
