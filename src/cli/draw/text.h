// SPDX-License-Identifier: MIT
#pragma once

#include "cli/draw/canvas.h"

#include <string>
#include <string_view>

/// Text in pictures, in DejaVu Sans, which is part of the program. Sizes are of an em, in pixels.
namespace voxtact::app {

/// Of UTF-8; what is none is drawn as a replacement character.
[[nodiscard]] double textWidth(std::string_view text, double size);
/// How high a capital is.
[[nodiscard]] double capitalHeight(double size);
/// As much of the beginning as is not wider, with an ellipsis where something is left out.
[[nodiscard]] std::string shortened(std::string_view text, double size, double widest);

/// The cover of a line of text whose first letter begins at x, on this base line.
[[nodiscard]] Mask textMask(std::string_view text, double size, const Point& base);
/// In white or black, whichever is seen better there, with a rim of the other round it: readable on any ground.
void drawText(Canvas& canvas, std::string_view text, double size, const Point& base);

/// What is seen well on a ground as bright as this: white or black.
[[nodiscard]] Colour inkOn(double brightness);

} // namespace voxtact::app
