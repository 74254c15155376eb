// SPDX-License-Identifier: MIT
#pragma once

#include "cli/draw/canvas.h"

#include <string>
#include <string_view>

/// Text in pictures, in the built-in font DejaVu Sans. Sizes: pixels per em.
namespace voxtact::app {

/// Returns the width of UTF-8 text; invalid bytes are drawn as a replacement character.
[[nodiscard]] double textWidth(std::string_view text, double size);
/// Returns the height of a capital letter.
[[nodiscard]] double capitalHeight(double size);
/// Returns the longest beginning that fits the width, with an ellipsis if shortened.
[[nodiscard]] std::string shortened(std::string_view text, double size, double widest);

/// Returns the coverage of a line of text that begins at x on the given base line.
[[nodiscard]] Mask textMask(std::string_view text, double size, const Point& base);
/// Draws in white or black, whichever has more contrast, with a rim of the other colour: readable on any background.
void drawText(Canvas& canvas, std::string_view text, double size, const Point& base);

/// Returns the colour with more contrast on this brightness: white or black.
[[nodiscard]] Colour inkOn(double brightness);

} // namespace voxtact::app
