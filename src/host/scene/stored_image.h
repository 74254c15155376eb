// SPDX-License-Identifier: MIT
#pragma once

#include "core/volume/bricks.h"
#include "core/volume/edit_rows.h"
#include "voxtact/data.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// Voxels of a side, beyond which a float cannot tell one from the next.
inline constexpr std::uint32_t kMaxSide = 1U << 23U;

/// Layout of the voxels in a StoredImage.
enum class Stored { UInt8, UInt16, Float };

/// The voxels as the exact arithmetic sees them, with one more layer on every side that repeats the outermost one. The
/// cell of a coordinate (exactCell()) whose lower voxel is `i`, from -1 to size-1, has its corners at i+1 and i+2 here:
/// no clamping.
struct StoredImage {
    explicit StoredImage(const VolumeView& volume);

    /// Replaces a row of voxels, including its copies, by voxels of the original type: `voxels` is the first one, the
    /// next is `step` bytes further on; 0: repeats the first.
    void replace(const VoxelRow& row, ScalarType from, const std::byte* voxels, std::size_t step);
    /// The voxels of a row, of the type that the image was made from, one after the other.
    void copy(const VoxelRow& row, ScalarType as, std::byte* voxels) const;

    Stored type = Stored::UInt8;
    std::array<std::int32_t, 3> size{};   ///< voxels of the image
    std::array<std::int64_t, 3> stride{}; ///< in voxels of the padded image
    std::vector<std::byte> bytes;         ///< includes padding, so lookups may read beyond the voxels

    template <class Visitor> auto visit(Visitor&& visitor) const {
        const void* first = bytes.data();
        switch (type) {
        case Stored::UInt8:
            return visitor(static_cast<const std::uint8_t*>(first));
        case Stored::UInt16:
            return visitor(static_cast<const std::uint16_t*>(first));
        case Stored::Float:
            break;
        }
        return visitor(static_cast<const float*>(first));
    }
};

/// The range of the stored values of each brick: of all the corners of its cells, and so of every sample in it.
struct BrickRanges {
    explicit BrickRanges(const StoredImage& image);

    /// Updates the bricks that a box of voxels meets. Not for an empty box.
    void update(const StoredImage& image, const VoxelBox& edited);

    std::array<std::int32_t, 3> count{};
    std::vector<float> lo;
    std::vector<float> hi;
};

} // namespace voxtact::cpu
