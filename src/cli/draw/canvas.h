// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

/// Draws on a finished picture with antialiased edges. Colours and opacities: 0 to 1. Origin: the upper left corner.
namespace voxtact::app {

struct Point {
    double x = 0;
    double y = 0;
};

struct Box2 {
    double left = 0;
    double top = 0;
    double right = 0;
    double bottom = 0;
    [[nodiscard]] double width() const { return right - left; }
    [[nodiscard]] double height() const { return bottom - top; }
};

/// Coverage of each pixel of a rectangle.
struct Mask {
    int left = 0;
    int top = 0;
    int width = 0;
    int height = 0;
    std::vector<float> cover; ///< row by row, 0..1
};

class Canvas {
  public:
    /// Draws on `pixels`, four bytes each.
    Canvas(std::span<std::uint8_t> rgba, std::uint32_t width, std::uint32_t height);

    [[nodiscard]] double width() const { return width_; }
    [[nodiscard]] double height() const { return height_; }

    void fill(const Box2& box, const Colour& colour, double opacity = 1);
    /// Fills a convex polygon.
    void fill(std::span<const Point> corners, const Colour& colour, double opacity = 1);
    void line(const Point& from, const Point& to, double thickness, const Colour& colour, double opacity = 1);
    /// Fills a disc.
    void dot(const Point& middle, double across, const Colour& colour, double opacity = 1);
    void outline(const Box2& box, double thickness, const Colour& colour, double opacity = 1);
    void blend(const Mask& mask, const Colour& colour, double opacity = 1);
    /// Returns the mean brightness of a rectangle, 0..1; ignores its part outside the picture.
    [[nodiscard]] double brightness(const Box2& box) const;

  private:
    void blendPixel(int x, int y, const Colour& colour, double opacity);

    std::span<std::uint8_t> rgba_;
    int width_;
    int height_;
};

} // namespace voxtact::app
