// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace voxtact::view {

/// How many voxels have a value in each of `bins` equal parts of `range`; those outside are in none.
[[nodiscard]] std::vector<std::uint64_t> histogram(const VolumeView& volume, const ValueRange& range, std::size_t bins);

/// Voxels of a box that are replaced by others.
struct ReplacedVoxels {
    ScalarType type{};
    VoxelBox box;
    std::span<const std::byte> before; ///< all of the box, x fastest
    std::span<const std::byte> after;  ///< the same
};
/// Makes a histogram over `range` that of the volume with them.
void recount(std::vector<std::uint64_t>& histogram, const ValueRange& range, const ReplacedVoxels& voxels);

/// The value of the voxel nearest to a world point, in the image's units; nothing outside of the image.
[[nodiscard]] std::optional<double> valueAt(const VolumeView& volume, const Mat4& texture_from_world,
                                            const Vec3& world);

} // namespace voxtact::view
