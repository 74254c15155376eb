// SPDX-License-Identifier: MIT
#include "viewer/model/shown/camera.h"

#include <algorithm>
#include <cmath>

namespace voxtact::view {

namespace {

constexpr double kHalfTurn = 180;

/// The picture's axis in the world: 0 to the right, 1 down, 2 forward.
Vec3 pictureAxis(const Camera& camera, std::size_t axis) {
    const Mat4 eye = eyeFromWorld(camera.direction);
    return {eye[axis], eye[4 + axis], eye[8 + axis]};
}

void move(Camera& camera, double right, double down) {
    const Vec3 x = pictureAxis(camera, 0);
    const Vec3 y = pictureAxis(camera, 1);
    for (std::size_t i = 0; i < 3; ++i) {
        camera.target[i] += right * x[i] + down * y[i];
    }
}

} // namespace

Camera framing(const Grid& grid, const ViewDirection& direction) noexcept {
    const Box box = transformBox(worldFromTexture(grid), {{0, 0, 0}, {1, 1, 1}});
    Camera camera;
    camera.direction = direction;
    double diagonal = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        camera.target[i] = (box.lo[i] + box.hi[i]) / 2;
        diagonal += (box.hi[i] - box.lo[i]) * (box.hi[i] - box.lo[i]);
    }
    // Half of the diagonal would frame the corners too, which are air in nearly all images.
    constexpr double kShare = 0.38;
    camera.halfHeight = std::clamp(kShare * std::sqrt(diagonal), kLeastHalfHeight, kMostHalfHeight);
    return camera;
}

void orbit(Camera& camera, double right, double down, const Extent& extent) noexcept {
    const double degrees = kHalfTurn / std::max<std::uint32_t>(extent.height, 1);
    camera.direction.azimuth = std::remainder(camera.direction.azimuth - right * degrees, 2 * kHalfTurn);
    camera.direction.elevation = std::clamp(camera.direction.elevation + down * degrees, -kHalfTurn / 2, kHalfTurn / 2);
}

void pan(Camera& camera, double right, double down, const Extent& extent) noexcept {
    const double mm = millimetresOfPixel(camera, extent);
    move(camera, -right * mm, -down * mm);
}

void zoom(Camera& camera, double factor, double x, double y, const Extent& extent) noexcept {
    const double before = millimetresOfPixel(camera, extent);
    camera.halfHeight = std::clamp(camera.halfHeight * factor, kLeastHalfHeight, kMostHalfHeight);
    const double change = before - millimetresOfPixel(camera, extent);
    move(camera, (x - extent.width / 2.0) * change, (y - extent.height / 2.0) * change);
}

Mat4 clipFromWorld(const Camera& camera, const Extent& extent, double depth) noexcept {
    const Mat4 eye = eyeFromWorld(camera.direction);
    const double aspect = static_cast<double>(extent.width) / std::max<std::uint32_t>(extent.height, 1);
    const Vec3 scale{1 / (camera.halfHeight * aspect), 1 / camera.halfHeight, 0.5 / depth};
    Mat4 out{};
    out[15] = 1;
    for (std::size_t row = 0; row < 3; ++row) {
        double offset = 0;
        for (std::size_t column = 0; column < 3; ++column) {
            out[4 * column + row] = scale[row] * eye[4 * column + row];
            offset -= out[4 * column + row] * camera.target[column];
        }
        out[12 + row] = offset + (row == 2 ? 0.5 : 0);
    }
    return out;
}

double millimetresOfPixel(const Camera& camera, const Extent& extent) noexcept {
    return 2 * camera.halfHeight / std::max<std::uint32_t>(extent.height, 1);
}

double barLength(double most) noexcept {
    if (!(most > 0) || !std::isfinite(most)) {
        return 0;
    }
    const double unit = std::pow(10, std::floor(std::log10(most)));
    for (const double times : {5.0, 2.0}) {
        if (times * unit <= most) {
            return times * unit;
        }
    }
    return unit;
}

} // namespace voxtact::view
