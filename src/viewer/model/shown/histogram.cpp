// SPDX-License-Identifier: MIT
#include "viewer/model/shown/histogram.h"

#include "core/volume/voxel_visit.h"

#include <algorithm>
#include <cmath>

namespace voxtact::view {

namespace {

constexpr std::size_t kMostParts = 65536; // all values of 16 bits

std::vector<std::uint64_t> counted(const VolumeView& volume, const ValueRange& range, std::size_t parts) {
    std::vector<std::uint64_t> counts(parts);
    const double scale = static_cast<double>(parts) / (range.hi - range.lo);
    visitVoxels(volume, [&](const auto* voxels) {
        const std::uint64_t all = voxelCount(volume.grid);
        for (std::uint64_t i = 0; i < all; ++i) {
            const auto value = static_cast<double>(voxels[i]);
            if (value >= range.lo && value <= range.hi) {
                ++counts[std::min(static_cast<std::size_t>((value - range.lo) * scale), parts - 1)];
            }
        }
    });
    return counts;
}

} // namespace

Histogram histogramOf(const VolumeView& volume, const ValueRange& domain) {
    const double least = std::ceil(domain.lo);
    const double numbers = std::floor(domain.hi) - least + 1;
    if (volume.type != ScalarType::Float32 && numbers >= 1 && numbers <= kMostParts) {
        const ValueRange range{least - 0.5, least + numbers - 0.5};
        return {range, counted(volume, range, static_cast<std::size_t>(numbers))};
    }
    return {domain, counted(volume, domain, kMostParts)};
}

Bars barsOf(const Histogram& histogram, const ValueRange& shown, std::size_t most) {
    const auto parts = static_cast<double>(histogram.counts.size());
    const double width = (histogram.range.hi - histogram.range.lo) / parts;
    const double from = std::max(std::floor((shown.lo - histogram.range.lo) / width), 0.0);
    const double to = std::min(std::ceil((shown.hi - histogram.range.lo) / width), parts);
    if (!(from < to)) {
        return {};
    }
    const auto end = static_cast<std::size_t>(to);
    const std::size_t group = (end - static_cast<std::size_t>(from) + most - 1) / most;
    const std::size_t begin = static_cast<std::size_t>(from) / group * group;
    Bars bars{histogram.range.lo + static_cast<double>(begin) * width, static_cast<double>(group) * width, {}};
    for (std::size_t part = begin; part < end; ++part) {
        if ((part - begin) % group == 0) {
            bars.counts.push_back(0);
        }
        bars.counts.back() += histogram.counts[part];
    }
    return bars;
}

void recount(Histogram& histogram, const ReplacedVoxels& voxels) {
    VolumeView box;
    box.grid.size = voxels.box.size;
    box.type = voxels.type;
    box.voxels = voxels.before;
    const std::vector<std::uint64_t> before = counted(box, histogram.range, histogram.counts.size());
    box.voxels = voxels.after;
    const std::vector<std::uint64_t> after = counted(box, histogram.range, histogram.counts.size());
    for (std::size_t part = 0; part < histogram.counts.size(); ++part) {
        histogram.counts[part] += after[part] - before[part];
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
