// SPDX-License-Identifier: MIT
#include "cli/render/orientation.h"
#include "core/geometry/vec3.h"

#include "cli/draw/text.h"
#include "core/geometry/patient_cube.h"

#include <algorithm>
#include <cmath>

namespace voxtact::app {

namespace {

constexpr double kMiddle = 0.5; // of the depth

/// Draws a letter on a side of the cube; `right` and `up` are the half sides.
void drawOnSide(Canvas& canvas, const char* letter, const Point& middle, const Point& right, const Point& up,
                const Colour& ink) {
    // Size of a mask finer than the picture.
    constexpr double kSize = 96;
    const double width = textWidth(letter, kSize);
    const Mask mask = textMask(letter, kSize, {0, 0});
    const double determinant = right.x * up.y - right.y * up.x;
    if (std::abs(determinant) < 1e-6) {
        return;
    }
    const double reach = std::hypot(right.x, right.y) + std::hypot(up.x, up.y);
    const auto from = [&](double at) { return static_cast<int>(std::floor(at - reach)); };
    Mask out{from(middle.x), from(middle.y), static_cast<int>(2 * reach) + 2, static_cast<int>(2 * reach) + 2, {}};
    out.cover.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height), 0);
    constexpr int kLooks = 3;
    constexpr double kLetter = 1.5; // of the half side: an em
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x) {
            float sum = 0;
            for (int i = 0; i < kLooks * kLooks; ++i) {
                const int lookX = i % kLooks;
                const int lookY = i / kLooks;
                const double dx = out.left + x + (lookX + 0.5) / kLooks - middle.x;
                const double dy = out.top + y + (lookY + 0.5) / kLooks - middle.y;
                const double a = (dx * up.y - dy * up.x) / determinant;
                const double b = (right.x * dy - right.y * dx) / determinant;
                // Base line and left edge of the mask are at 0.
                const auto column = static_cast<int>(std::floor(a * kSize / kLetter + width / 2)) - mask.left;
                const auto row =
                    static_cast<int>(std::floor(-b * kSize / kLetter - capitalHeight(kSize) / 2)) - mask.top;
                if (column >= 0 && row >= 0 && column < mask.width && row < mask.height) {
                    sum += mask.cover[static_cast<std::size_t>(row) * static_cast<std::size_t>(mask.width) +
                                      static_cast<std::size_t>(column)];
                }
            }
            out.cover[static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) + static_cast<std::size_t>(x)] =
                sum / (kLooks * kLooks);
        }
    }
    canvas.blend(out, ink);
}

} // namespace

std::optional<ScreenAxes> screenAxes(const Mat4& clip_from_world) {
    const Result<Mat4> world_from_clip = inverse(clip_from_world);
    if (!world_from_clip.ok()) {
        return std::nullopt;
    }
    const auto at = [&](double x, double y, double z) { return transformPoint(*world_from_clip, {x, y, z}); };
    constexpr double kStep = 1e-3;
    const Vec3 middle = at(0, 0, kMiddle);
    ScreenAxes axes;
    axes.right = minus(at(kStep, 0, kMiddle), middle);
    axes.up = minus(at(0, -kStep, kMiddle), middle);
    if (!(length(axes.right) > 0) || !(length(axes.up) > 0)) {
        return std::nullopt;
    }
    axes.right = unit(axes.right);
    axes.up = unit(axes.up);
    axes.towardsEye = unit(cross(axes.right, axes.up));
    return axes;
}

std::optional<double> pixelSize(const Mat4& clip_from_world, double width, double height) {
    const Result<Mat4> world_from_clip = inverse(clip_from_world);
    const bool perspective = clip_from_world[3] != 0 || clip_from_world[7] != 0 || clip_from_world[11] != 0;
    if (!world_from_clip.ok() || perspective) {
        return std::nullopt;
    }
    const auto at = [&](double x, double y) { return transformPoint(*world_from_clip, {x, y, kMiddle}); };
    const double across = length(minus(at(1, 0), at(-1, 0))) / width;
    const double along = length(minus(at(0, 1), at(0, -1))) / height;
    constexpr double kSquare = 1e-3;
    return std::abs(across - along) <= kSquare * across ? std::optional(across) : std::nullopt;
}

std::string sideLetters(const Vec3& direction) {
    constexpr double kShare = 0.35;
    std::array<std::size_t, 3> order{0, 1, 2};
    std::ranges::sort(order,
                      [&](std::size_t a, std::size_t b) { return std::abs(direction[a]) > std::abs(direction[b]); });
    std::string letters;
    for (const std::size_t axis : {order[0], order[1]}) {
        if (letters.empty() || std::abs(direction[axis]) > kShare) {
            letters += patientSide(axis, direction[axis] < 0).letter;
        }
    }
    return letters;
}

void drawCube(Canvas& canvas, const Mat4& clip_from_world, const Box2& box) {
    const std::optional<ScreenAxes> axes = screenAxes(clip_from_world);
    if (!axes) {
        return;
    }
    const Point middle{(box.left + box.right) / 2, (box.top + box.bottom) / 2};
    const double half = box.width() / 2 / kCubeReach;
    const auto scaled = [half](const std::array<double, 2>& at) { return Point{half * at[0], half * at[1]}; };
    for (const SeenSide& side : seenSides(axes->right, axes->up)) {
        const Point at = scaled(side.middle);
        const Point up = scaled(side.up);
        const Point right = scaled(side.right);
        const Point centre{middle.x + at.x, middle.y + at.y};
        std::array<Point, 4> corners{};
        constexpr int kAround[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        for (std::size_t i = 0; i < corners.size(); ++i) {
            corners[i] = {centre.x + kAround[i][0] * right.x + kAround[i][1] * up.x,
                          centre.y + kAround[i][0] * right.y + kAround[i][1] * up.y};
        }
        const double shade = 0.30 + 0.28 * side.facing;
        canvas.fill(corners, {shade, shade, 1.06 * shade});
        for (std::size_t i = 0; i < corners.size(); ++i) {
            canvas.line(corners[i], corners[(i + 1) % 4], std::max(1.0, half / 22), {0.85, 0.87, 0.9});
        }
        drawOnSide(canvas, kPatientSides[side.side].letter, centre, right, up, {1, 1, 1});
    }
}

} // namespace voxtact::app
