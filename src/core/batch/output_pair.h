// SPDX-License-Identifier: MIT
#pragma once

#include "exact/contact.h"
#include "voxtact/data.h"
#include "voxtact/results.h"

#include <span>

namespace voxtact {

/// Returns the constants of a pair for the outputs, without labels and buffer offsets: the same for all pairs of an
/// item, and the same numbers on device and host. `item` is that of the exact filter; value = valueScale * stored +
/// valueBias. Expects a positive maxDepth if contacts are requested.
[[nodiscard]] shader::OutputPair outputPair(const Grid& grid, const Mat4& texture_from_world,
                                            const shader::ItemConstants& item, double valueScale, double valueBias,
                                            const Outputs& outputs);

/// Adds a label map whose labels are `values`. `grid` is that of the volume.
void addLabelMap(shader::OutputPair& pair, const Grid& grid, const Grid& labelGrid,
                 std::span<const std::int32_t> values);

/// Refuses outputs with early exit and, for contacts, a maximum depth that is not a positive number.
[[nodiscard]] Result<void> checkOutputs(const Outputs& outputs, bool stopAtFirst);

/// Refuses labels that makeLabels() would not make, their indices aside. O(labels).
[[nodiscard]] Result<void> checkLabelValues(const LabelData& labels);
/// Refuses what checkLabelValues() refuses, and an index beyond the values. O(voxels).
[[nodiscard]] Result<void> checkLabels(const LabelData& labels);

} // namespace voxtact
