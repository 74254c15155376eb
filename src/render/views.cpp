// SPDX-License-Identifier: MIT
#include "core/base/infinity.h"
#include "voxtact/looks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxtact {

namespace {

/// Keeps the box off the edge of the picture and off the near and far planes.
constexpr double kMargin = 1.02;

constexpr Box kNothing{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

/// Returns the bounding box of a transformed box.
Box boxOf(const Box& box, const Mat4& matrix) {
    Box out = kNothing;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3 at = transformPoint(matrix, {(corner & 1U) != 0 ? box.hi[0] : box.lo[0],
                                                (corner & 2U) != 0 ? box.hi[1] : box.lo[1],
                                                (corner & 4U) != 0 ? box.hi[2] : box.lo[2]});
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out.lo[axis] = std::min(out.lo[axis], at[axis]);
            out.hi[axis] = std::max(out.hi[axis], at[axis]);
        }
    }
    return out;
}

} // namespace

Vec3 towardsEye(const ViewDirection& direction) noexcept {
    const Mat4 rows = eyeFromWorld(direction);
    return {-rows[2], -rows[6], -rows[10]};
}

Mat4 eyeFromWorld(const ViewDirection& direction) noexcept {
    const double azimuth = direction.azimuth * std::numbers::pi / 180;
    const double elevation = direction.elevation * std::numbers::pi / 180;
    const Vec3 right{std::cos(azimuth), std::sin(azimuth), 0};
    const Vec3 up{-std::sin(elevation) * std::sin(azimuth), std::sin(elevation) * std::cos(azimuth),
                  std::cos(elevation)};
    const Vec3 toEye{std::cos(elevation) * std::sin(azimuth), -std::cos(elevation) * std::cos(azimuth),
                     std::sin(elevation)};
    Mat4 out = identity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out[4 * axis] = right[axis];
        out[4 * axis + 1] = -up[axis];
        out[4 * axis + 2] = -toEye[axis];
    }
    return out;
}

std::optional<ViewDirection> directionNamed(std::string_view name) noexcept {
    struct Named {
        const char* name;
        ViewDirection direction;
    };
    constexpr Named kNamed[] = {{"front", {0, 0}},   {"left", {90, 0}},  {"back", {180, 0}},
                                {"right", {-90, 0}}, {"top", {180, 90}}, {"bottom", {0, -90}}};
    for (const Named& named : kNamed) {
        if (name == named.name) {
            return named.direction;
        }
    }
    return std::nullopt;
}

Mat4 viewFrom(const ViewDirection& direction, const Grid& grid, const std::optional<Box>& also, std::uint32_t width,
              std::uint32_t height, const std::optional<ViewFrame>& part) noexcept {
    const ViewFrame frame = part.value_or(ViewFrame{0, 0, static_cast<double>(width), static_cast<double>(height)});
    const Mat4 eye_from_world = eyeFromWorld(direction);
    const Box volume = boxOf({{0, 0, 0}, {1, 1, 1}}, multiply(eye_from_world, worldFromTexture(grid)));
    double nearest = volume.lo[2];
    double farthest = volume.hi[2];
    if (also) {
        const Box box = boxOf(*also, eye_from_world);
        nearest = std::min(nearest, box.lo[2]);
        farthest = std::max(farthest, box.hi[2]);
    }
    const double x = (volume.lo[0] + volume.hi[0]) / 2;
    const double y = (volume.lo[1] + volume.hi[1]) / 2;
    const double z = (nearest + farthest) / 2;
    // Millimetres of a pixel: enough for the tighter side.
    const double pixel = kMargin * std::max((volume.hi[0] - volume.lo[0]) / (frame.right - frame.left),
                                            (volume.hi[1] - volume.lo[1]) / (frame.bottom - frame.top));
    const double depth = kMargin * (farthest - nearest);
    Mat4 clip_from_eye{};
    clip_from_eye[0] = 2 / (pixel * width);
    clip_from_eye[5] = 2 / (pixel * height);
    clip_from_eye[10] = 1 / depth;
    clip_from_eye[12] = (frame.left + frame.right) / width - 1 - x * clip_from_eye[0];
    clip_from_eye[13] = (frame.top + frame.bottom) / height - 1 - y * clip_from_eye[5];
    clip_from_eye[14] = 0.5 - z * clip_from_eye[10];
    clip_from_eye[15] = 1;
    return multiply(clip_from_eye, eye_from_world);
}

} // namespace voxtact
