// SPDX-License-Identifier: MIT
#include "cli/draw/canvas.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxtact::app {

namespace {

constexpr std::size_t kChannels = 4;
/// Samples of a polygon per side of a pixel.
constexpr int kSamples = 4;

/// True if a point is on the inner side of every edge, for either orientation.
bool isInside(std::span<const Point> corners, const Point& at) {
    bool left = false;
    bool right = false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point& a = corners[i];
        const Point& b = corners[(i + 1) % corners.size()];
        const double side = (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x);
        left = left || side > 0;
        right = right || side < 0;
    }
    return !(left && right);
}

/// Returns the covered share of the pixel.
double coverage(std::span<const Point> corners, int x, int y) {
    int inside = 0;
    for (int i = 0; i < kSamples * kSamples; ++i) {
        const int column = i % kSamples;
        const int row = i / kSamples;
        const Point at{x + (column + 0.5) / kSamples, y + (row + 0.5) / kSamples};
        inside += isInside(corners, at) ? 1 : 0;
    }
    return static_cast<double>(inside) / (kSamples * kSamples);
}

struct Pixels {
    int left;
    int top;
    int right;
    int bottom;
};

/// Returns whole pixels, also for a point far outside the picture.
int within(double at, int max) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(max)));
}

} // namespace

Canvas::Canvas(std::span<std::uint8_t> rgba, std::uint32_t width, std::uint32_t height)
    : rgba_(rgba), width_(static_cast<int>(width)), height_(static_cast<int>(height)) {}

void Canvas::blendPixel(int x, int y, const Colour& colour, double opacity) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_ || opacity <= 0) {
        return;
    }
    const std::size_t at =
        kChannels * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x));
    for (std::size_t channel = 0; channel < colour.size(); ++channel) {
        const double before = rgba_[at + channel];
        rgba_[at + channel] =
            static_cast<std::uint8_t>(std::lround(before + std::min(opacity, 1.0) * (255 * colour[channel] - before)));
    }
}

void Canvas::fill(std::span<const Point> corners, const Colour& colour, double opacity) {
    if (corners.empty()) {
        return;
    }
    Box2 box{corners[0].x, corners[0].y, corners[0].x, corners[0].y};
    for (const Point& corner : corners) {
        box = {std::min(box.left, corner.x), std::min(box.top, corner.y), std::max(box.right, corner.x),
               std::max(box.bottom, corner.y)};
    }
    const Pixels pixels{within(std::floor(box.left), width_), within(std::floor(box.top), height_),
                        within(std::ceil(box.right), width_), within(std::ceil(box.bottom), height_)};
    for (int y = pixels.top; y < pixels.bottom; ++y) {
        for (int x = pixels.left; x < pixels.right; ++x) {
            blendPixel(x, y, colour, opacity * coverage(corners, x, y));
        }
    }
}

void Canvas::fill(const Box2& box, const Colour& colour, double opacity) {
    const Point corners[] = {
        {box.left, box.top}, {box.right, box.top}, {box.right, box.bottom}, {box.left, box.bottom}};
    fill(corners, colour, opacity);
}

void Canvas::line(const Point& from, const Point& to, double thickness, const Colour& colour, double opacity) {
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    if (!(length > 0)) {
        return;
    }
    const double x = (to.y - from.y) / length * thickness / 2;
    const double y = (from.x - to.x) / length * thickness / 2;
    const Point corners[] = {
        {from.x + x, from.y + y}, {to.x + x, to.y + y}, {to.x - x, to.y - y}, {from.x - x, from.y - y}};
    fill(corners, colour, opacity);
}

void Canvas::dot(const Point& middle, double across, const Colour& colour, double opacity) {
    constexpr std::size_t kCorners = 12;
    std::array<Point, kCorners> corners{};
    for (std::size_t i = 0; i < kCorners; ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kCorners;
        corners[i] = {middle.x + across / 2 * std::cos(angle), middle.y + across / 2 * std::sin(angle)};
    }
    fill(corners, colour, opacity);
}

void Canvas::outline(const Box2& box, double thickness, const Colour& colour, double opacity) {
    const double t = thickness;
    fill(Box2{box.left, box.top, box.right, box.top + t}, colour, opacity);
    fill(Box2{box.left, box.bottom - t, box.right, box.bottom}, colour, opacity);
    fill(Box2{box.left, box.top + t, box.left + t, box.bottom - t}, colour, opacity);
    fill(Box2{box.right - t, box.top + t, box.right, box.bottom - t}, colour, opacity);
}

void Canvas::blend(const Mask& mask, const Colour& colour, double opacity) {
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            const std::size_t at =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width) + static_cast<std::size_t>(x);
            blendPixel(mask.left + x, mask.top + y, colour, opacity * static_cast<double>(mask.cover[at]));
        }
    }
}

double Canvas::brightness(const Box2& box) const {
    double sum = 0;
    double count = 0;
    for (int y = std::max(0, static_cast<int>(box.top)); y < std::min(height_, static_cast<int>(box.bottom)); ++y) {
        for (int x = std::max(0, static_cast<int>(box.left)); x < std::min(width_, static_cast<int>(box.right)); ++x) {
            const std::size_t at = kChannels * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                                static_cast<std::size_t>(x));
            // ITU-R BT.709.
            sum += (0.2126 * rgba_[at] + 0.7152 * rgba_[at + 1] + 0.0722 * rgba_[at + 2]) / 255;
            count += 1;
        }
    }
    return count > 0 ? sum / count : 0;
}

} // namespace voxtact::app
