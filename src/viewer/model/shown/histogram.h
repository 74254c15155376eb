// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace voxtact::view {

/// Histogram of voxel values, fine enough for any visible range.
struct Histogram {
    ValueRange range;                  ///< divided into equal parts by `counts`; the upper end belongs to the last part
    std::vector<std::uint64_t> counts; ///< voxels outside of the range are in none

    [[nodiscard]] bool operator==(const Histogram& other) const {
        return range.lo == other.range.lo && range.hi == other.range.hi && counts == other.counts;
    }
};

/// Counts the values of a domain: whole numbers in one bin each, centred; others in 65,536 bins.
[[nodiscard]] Histogram histogramOf(const VolumeView& volume, const ValueRange& domain);

/// Visible part of a histogram, as adjacent bars.
struct Bars {
    double first = 0; ///< where the first one begins
    double width = 1; ///< of each: a whole number of the histogram's parts
    std::vector<std::uint64_t> counts;
};
/// Returns at most `most` + 1 bars that cover a range of values; none if the histogram has none there. They begin at
/// multiples of their width, so they stay the same while the range moves.
[[nodiscard]] Bars barsOf(const Histogram& histogram, const ValueRange& shown, std::size_t most);

/// Voxels of a box that are replaced by others.
struct ReplacedVoxels {
    ScalarType type{};
    VoxelBox box;
    std::span<const std::byte> before; ///< all of the box, x fastest
    std::span<const std::byte> after;  ///< the same
};
/// Updates a histogram for the replaced voxels.
void recount(Histogram& histogram, const ReplacedVoxels& voxels);

/// Returns the value of the voxel nearest to a world point, in the image's units; empty outside the image.
[[nodiscard]] std::optional<double> valueAt(const VolumeView& volume, const Mat4& texture_from_world,
                                            const Vec3& world);

} // namespace voxtact::view
