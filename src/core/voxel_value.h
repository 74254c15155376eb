// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/edit.h"

#include <array>
#include <cstddef>
#include <span>

namespace voxtact {

/// A voxel of any type: the first bytesPerVoxel(type) bytes.
using VoxelBytes = std::array<std::byte, 4>;

/// Refuses NaN and infinity, for integers what is not a whole number within the type's range, for floats what is
/// beyond the largest one. Floats are rounded to the nearest.
[[nodiscard]] Result<VoxelBytes> voxelOf(ScalarType type, double value);

/// Refuses voxels of the wrong number of bytes for a box of such voxels, and floats that are NaN or infinite (the first
/// is named).
[[nodiscard]] Result<void> checkVoxels(ScalarType type, const VoxelBox& box, std::span<const std::byte> voxels);

} // namespace voxtact
