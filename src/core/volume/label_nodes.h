// SPDX-License-Identifier: MIT
#pragma once

#include "clearance_words.h"
#include "voxtact/data.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxtact {

/// Which labels a brick may have, or a node of a level above: a bit for each number modulo VOXTACT_LABEL_BITS.
using LabelBits = std::array<std::uint32_t, VOXTACT_LABEL_BITS / 32>;

/// Nodes of all levels of brick_levels.h, of a grid.
[[nodiscard]] std::uint64_t labelNodeCount(const Grid& grid) noexcept;
/// Of each node, level by level, the labels of the voxels that are corners of its cells.
[[nodiscard]] std::vector<LabelBits> labelNodes(const LabelData& labels);

} // namespace voxtact
