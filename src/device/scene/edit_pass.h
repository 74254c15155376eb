// SPDX-License-Identifier: MIT
#pragma once

#include "core/volume/edit_rows.h"
#include "device/scene/scene_impl.h"

namespace voxtact {

/// Makes what edits of an editable volume need: room for some slices of texels and their rows, and the pass that
/// changes the rows.
[[nodiscard]] Result<void> makeEditPass(VolumeImpl& volume);

/// Slices of a box that an edit takes at once.
[[nodiscard]] std::uint32_t slicesAtOnce(const VolumeImpl& volume, const VoxelBox& box) noexcept;

/// Records the change of texels that VolumeImpl::editScratch holds, those of `box`, as far as they are in `rows`;
/// `word` has the new texel as often as it fits. Between barriers of the caller's.
void cmdChangeRows(const VolumeImpl& volume, VkCommandBuffer commandBuffer, const VoxelBox& box, std::uint32_t word);

/// What cmdChangeRows() reads of the rows of a box: two words for each row of it.
[[nodiscard]] std::vector<std::uint32_t> rowTable(std::span<const VoxelRow> rows, const VoxelBox& box);

} // namespace voxtact
