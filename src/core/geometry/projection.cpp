// SPDX-License-Identifier: MIT
#include "core/geometry/projection.h"
#include "core/base/refuse.h"
#include "core/method/method_table.h"

#include <algorithm>

namespace voxtact {

namespace {

constexpr Mat4 kNoCamera{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 1};

std::uint32_t mostVoxels(const Grid& grid) {
    return std::max({grid.size[0], grid.size[1], grid.size[2]});
}

} // namespace

Cameras::Cameras(Projection projection, const View& view) noexcept : count_(viewsPerPair(projection)) {
    matrices_[0] = usesView(projection) ? view.clip_from_world : kNoCamera;
    if (count_ > 1) {
        matrices_[1] = sideView(view.clip_from_world);
    }
}

std::uint32_t viewsPerPair(Projection projection) noexcept {
    return rowOf(projection).views;
}

std::uint64_t dominantSide(const Grid& grid, std::uint32_t samplesPerVoxel) noexcept {
    return std::uint64_t{samplesPerVoxel} * mostVoxels(grid);
}

shader::DominantGrid dominantGrid(const Grid& grid) noexcept {
    // pixel = samples * voxels and clip = 2 * pixel / side - 1: the samples cancel.
    return {static_cast<float>(grid.size[0]), static_cast<float>(grid.size[1]), static_cast<float>(grid.size[2]),
            static_cast<float>(2.0 / mostVoxels(grid))};
}

std::string dominantNeeds(const Grid& grid, std::uint32_t samplesPerVoxel) {
    const std::string side = std::to_string(dominantSide(grid, samplesPerVoxel));
    return "dominant-axis with " + std::to_string(samplesPerVoxel) + " samples per voxel needs a viewport of " + side +
           "x" + side;
}

Result<void> checkSamples(std::uint32_t samplesPerVoxel) {
    if (samplesPerVoxel < 1 || samplesPerVoxel > kMaxSamplesPerVoxel) {
        return refuse("the number of samples per voxel is " + std::to_string(samplesPerVoxel) + ", it must be 1 to " +
                      std::to_string(kMaxSamplesPerVoxel));
    }
    return {};
}

} // namespace voxtact
