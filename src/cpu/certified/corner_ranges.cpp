// SPDX-License-Identifier: MIT
#include "cpu/certified/corner_ranges.h"
#include "cpu/scene/stored_voxels.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

constexpr std::int32_t kCorners = CornerRanges::kCorners;

template <class Kept>
void loadCorners(const StoredImage& image, const Kept* voxels, const shader::CertifiedItem& item,
                 const std::array<std::int32_t, 3>& place, CornerRanges& out) {
    std::array<std::int64_t, 3> first{};
    std::array<std::int64_t, 3> last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = std::int64_t{place[axis]} << kBrickShift;
        // Cells beyond the last are no cells: whatever stands there is not looked at.
        last[axis] = std::int64_t{image.size[axis]} + 1;
    }
    for (std::int64_t z = 0; z < kCorners; ++z) {
        for (std::int64_t y = 0; y < kCorners; ++y) {
            const Kept* row = voxels + std::min(first[1] + y, last[1]) * image.stride[1] +
                              std::min(first[2] + z, last[2]) * image.stride[2];
            for (std::int64_t x = 0; x < kCorners; ++x) {
                out.lo[z][y][x] = shader::certifiedEntry(item, storedValue(row[std::min(first[0] + x, last[0])]));
                out.hi[z][y][x] = out.lo[z][y][x];
                out.finite = out.finite && std::isfinite(out.lo[z][y][x]);
            }
        }
    }
}

void reduce(CornerRanges& ranges) {
    const auto merge = [&](int z, int y, int x, int otherZ, int otherY, int otherX) {
        ranges.lo[z][y][x] = shader::certifiedMin(ranges.lo[z][y][x], ranges.lo[otherZ][otherY][otherX]);
        ranges.hi[z][y][x] = shader::certifiedMax(ranges.hi[z][y][x], ranges.hi[otherZ][otherY][otherX]);
    };
    for (int z = 0; z < kCorners; ++z) {
        for (int y = 0; y < kCorners; ++y) {
            for (int x = 0; x < kBrickSide; ++x) {
                merge(z, y, x, z, y, x + 1);
            }
        }
    }
    for (int z = 0; z < kCorners; ++z) {
        for (int y = 0; y < kBrickSide; ++y) {
            for (int x = 0; x < kBrickSide; ++x) {
                merge(z, y, x, z, y + 1, x);
            }
        }
    }
    for (int z = 0; z < kBrickSide; ++z) {
        for (int y = 0; y < kBrickSide; ++y) {
            for (int x = 0; x < kBrickSide; ++x) {
                merge(z, y, x, z + 1, y, x);
            }
        }
    }
}

} // namespace

CornerRanges cornerRangesOf(const StoredImage& image, const shader::CertifiedItem& item,
                            const std::array<std::int32_t, 3>& place) {
    CornerRanges ranges;
    image.visit([&](const auto* voxels) { loadCorners(image, voxels, item, place, ranges); });
    reduce(ranges);
    return ranges;
}

} // namespace voxtact::cpu
