// SPDX-License-Identifier: MIT
#include "core/base/infinity.h"
#include "voxtact/data.h"

#include <algorithm>

namespace voxtact {

namespace {

/// Keeps the box's own faces off the edge of the viewport and off the near and far planes.
constexpr double kFramingMargin = 1.01;

/// sideView()'s clip coordinates from the first camera's.
constexpr Mat4 kSideFromClip{0, 0, 0.5, 0, 0, 1, 0, 0, 2, 0, 0, 0, -1, 0, 0.5, 1};

Box worldBox(const Grid& grid) {
    const Mat4 world_from_texture = worldFromTexture(grid);
    Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3 world =
            transformPoint(world_from_texture, {(corner & 1U) != 0 ? 1.0 : 0.0, (corner & 2U) != 0 ? 1.0 : 0.0,
                                                (corner & 4U) != 0 ? 1.0 : 0.0});
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = std::min(box.lo[axis], world[axis]);
            box.hi[axis] = std::max(box.hi[axis], world[axis]);
        }
    }
    return box;
}

} // namespace

Mat4 framingCamera(const Grid& grid, std::uint32_t width, std::uint32_t height) noexcept {
    const Box box = worldBox(grid);
    double centre[3];
    double half[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        centre[axis] = (box.lo[axis] + box.hi[axis]) / 2;
        half[axis] = (box.hi[axis] - box.lo[axis]) / 2 * kFramingMargin;
    }
    // Millimetres in half a pixel: the same along both axes, and enough for the longer one.
    const double halfPixel = std::max(half[0] / width, half[1] / height);
    const double sx = -1 / (halfPixel * width);
    const double sy = 1 / (halfPixel * height);
    const double sz = -1 / (2 * half[2]);
    Mat4 clip_from_world{};
    clip_from_world[0] = sx;
    clip_from_world[5] = sy;
    clip_from_world[10] = sz;
    clip_from_world[12] = -sx * centre[0];
    clip_from_world[13] = -sy * centre[1];
    clip_from_world[14] = 0.5 - sz * centre[2];
    clip_from_world[15] = 1;
    return clip_from_world;
}

Mat4 sideView(const Mat4& clip_from_world) noexcept {
    return multiply(kSideFromClip, clip_from_world);
}

} // namespace voxtact
