// SPDX-License-Identifier: MIT
#pragma once

#include "support/scenes.h"

#include <array>
#include <cmath>

namespace voxtact::test {

/// Opaque where z is below 0, under `kFloorPoints` and a threshold of one half: voxels of 1 mm, x and y from -20 to 20.
inline VolumeData floorImage() {
    Grid grid;
    grid.size = {41, 41, 21};
    grid.origin = {-20, -20, -10};
    return makeVolume<float>(grid, ScalarType::Float32, [](auto, auto, auto z) { return 10.0 - z; });
}

/// The ramp is linear over all values, and one half at 0.
inline constexpr std::array kFloorPoints{ControlPoint{-10, 0}, ControlPoint{10, 1}};
inline constexpr ValueRange kFloorDomain{-10, 10};
inline constexpr std::uint32_t kFloorEntries = 1024;

/// About an axis of the world, right-handed, through the origin; radians.
inline Mat4 turned(std::size_t axis, double angle) {
    Mat4 out = identity();
    const std::size_t next = (axis + 1) % 3;
    const std::size_t last = (axis + 2) % 3;
    out[4 * next + next] = out[4 * last + last] = std::cos(angle);
    out[4 * next + last] = std::sin(angle);
    out[4 * last + next] = -std::sin(angle);
    return out;
}

} // namespace voxtact::test
