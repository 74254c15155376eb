// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <array>
#include <cstddef>
#include <span>

namespace voxtact {

/// A voxel of any type: the first bytesPerVoxel(type) bytes.
using VoxelBytes = std::array<std::byte, 4>;

/// Returns the voxel of an edit's value, on the host and on the device. Refuses NaN and infinity, for integers a number
/// that is not whole or out of range, for floats a number beyond the largest one. Floats are rounded to the nearest.
[[nodiscard]] Result<VoxelBytes> voxelOf(ScalarType type, double value);
/// Returns the value of a voxel.
[[nodiscard]] double valueOf(ScalarType type, const VoxelBytes& voxel) noexcept;

/// Refuses a wrong number of bytes for a box of such voxels.
[[nodiscard]] Result<void> checkVoxelBytes(ScalarType type, const VoxelBox& box, std::size_t bytes);
/// Refuses voxels of the wrong number of bytes for a box of such voxels, and floats that are NaN or infinite (the first
/// is named). Returns the smallest and largest; zeros for an empty box. Voxels of any alignment.
[[nodiscard]] Result<ValueRange> checkVoxels(ScalarType type, const VoxelBox& box, std::span<const std::byte> voxels);

} // namespace voxtact
