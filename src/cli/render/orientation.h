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

/// Returns the directions; empty for a camera that cannot be inverted.
[[nodiscard]] std::optional<ScreenAxes> screenAxes(const Mat4& clip_from_world);
/// Returns the millimetres per pixel; empty if they vary: in perspective, or for pixels that are not square.
[[nodiscard]] std::optional<double> pixelSize(const Mat4& clip_from_world, double width, double height);

/// Returns the nearest side of the patient, and a second one that has a share: L left, R right, A anterior, P
/// posterior, S superior, I inferior.
[[nodiscard]] std::string sideLetters(const Vec3& direction);

/// Draws a cube oriented like the patient, with a letter on each side.
void drawCube(Canvas& canvas, const Mat4& clip_from_world, const Box2& box);

} // namespace voxtact::app
