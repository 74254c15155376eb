// SPDX-License-Identifier: MIT
#pragma once

#include "cli/draw/canvas.h"

#include <optional>
#include <string>

/// Directions of the patient's sides in a picture.
namespace voxtact::app {

/// Directions of world space, of unit length, in the middle of a picture.
struct ScreenAxes {
    Vec3 right{};
    Vec3 up{};
    Vec3 towardsEye{};
};

/// Empty for a camera that cannot be inverted.
[[nodiscard]] std::optional<ScreenAxes> screenAxes(const Mat4& clip_from_world);
/// Millimetres of a pixel; nothing where they are not the same everywhere: in perspective, or where pixels are not
/// square.
[[nodiscard]] std::optional<double> pixelSize(const Mat4& clip_from_world, double width, double height);

/// L left, R right, A anterior, P posterior, S superior, I inferior: the nearest, and after it a second that has a
/// share, too.
[[nodiscard]] std::string sideLetters(const Vec3& direction);

/// A cube as the patient lies, with a letter on each side.
void drawCube(Canvas& canvas, const Mat4& clip_from_world, const Box2& box);

} // namespace voxtact::app
