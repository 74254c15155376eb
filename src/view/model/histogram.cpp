// SPDX-License-Identifier: MIT
#include "view/model/histogram.h"

#include "core/volume/voxel_visit.h"

#include <algorithm>
#include <cmath>

namespace voxtact::view {

std::vector<std::uint64_t> histogram(const VolumeView& volume, const ValueRange& range, std::size_t bins) {
    std::vector<std::uint64_t> counts(bins);
    const double scale = static_cast<double>(bins) / (range.hi - range.lo);
    visitVoxels(volume, [&](const auto* voxels) {
        const std::uint64_t all = voxelCount(volume.grid);
        for (std::uint64_t i = 0; i < all; ++i) {
            const auto value = static_cast<double>(voxels[i]);
            if (value >= range.lo && value <= range.hi) {
                ++counts[std::min(static_cast<std::size_t>((value - range.lo) * scale), bins - 1)];
            }
        }
    });
    return counts;
}

void recount(std::vector<std::uint64_t>& histogram, const ValueRange& range, const ReplacedVoxels& voxels) {
    VolumeView box;
    box.grid.size = voxels.box.size;
    box.type = voxels.type;
    box.voxels = voxels.before;
    const std::vector<std::uint64_t> before = view::histogram(box, range, histogram.size());
    box.voxels = voxels.after;
    const std::vector<std::uint64_t> after = view::histogram(box, range, histogram.size());
    for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
        histogram[bin] += after[bin] - before[bin];
    }
}

std::optional<double> valueAt(const VolumeView& volume, const Mat4& texture_from_world, const Vec3& world) {
    const Vec3 texture = transformPoint(texture_from_world, world);
    std::uint64_t index = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
        if (!(texture[axis] >= 0 && texture[axis] <= 1)) {
            return std::nullopt;
        }
        const std::uint32_t size = volume.grid.size[axis];
        const auto voxel = static_cast<std::uint64_t>(texture[axis] * size);
        index = index * size + std::min<std::uint64_t>(voxel, size - 1);
    }
    return visitVoxels(volume, [index](const auto* voxels) { return static_cast<double>(voxels[index]); });
}

} // namespace voxtact::view
