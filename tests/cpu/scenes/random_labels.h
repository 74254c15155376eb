// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/oracle_scenes.h"
#include "support/scenes.h"
#include "support/take.h"

#include <random>

namespace voxtact::test {

/// A map of the labels 0 to 3 on a grid, in blocks of one voxel or a few.
[[nodiscard]] inline LabelData randomLabels(std::mt19937_64& random, const Grid& grid) {
    const std::uint64_t key = random();
    const std::size_t size = 1 + random() % 3;
    return take(makeLabels(makeBytes(grid, [&](auto x, auto y, auto z) {
                               std::uint64_t h = key ^ (x / size + 31ULL * (y / size) + 1009ULL * (z / size));
                               h = (h ^ h >> 31U) * 0x9e3779b97f4a7c15ULL;
                               return static_cast<double>((h >> 40U) % 4);
                           }).view()));
}

} // namespace voxtact::test
