// SPDX-License-Identifier: MIT
#pragma once

#include "exact/shared.h"

#include <algorithm>
#include <cstdint>

/// The bricks of an image, one definition for host and device. Along an axis of n voxels, cell i, from -1 to n-1, lies
/// between the centres of voxels i and i+1, clamped to the image; its padded number is i+1, from 0 to n. A brick is
/// 2^kBrickShift cells per side, beginning at padded cell 0.
namespace voxtact {

inline constexpr int kBrickShift = VOXTACT_BRICK_SHIFT;

/// The bricks along an axis of `voxels`.
[[nodiscard]] constexpr std::int32_t brickCount(std::int32_t voxels) noexcept {
    return (voxels >> kBrickShift) + 1;
}

/// Bricks along an axis.
struct BrickSpan {
    std::int32_t first = 0;
    std::int32_t end = 0;
};

/// The bricks whose wide range has one of the voxels [first, end) of an axis of `voxels`: the corners of a brick's
/// cells are voxels 8b-1 to 8b+7, those of the cells one farther out 8b-2 to 8b+8.
[[nodiscard]] constexpr BrickSpan bricksOfVoxels(std::int32_t first, std::int32_t end, std::int32_t voxels) noexcept {
    return {std::max(first - 1, 0) >> kBrickShift, std::min((end + 1) >> kBrickShift, brickCount(voxels) - 1) + 1};
}

} // namespace voxtact
