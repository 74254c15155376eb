// SPDX-License-Identifier: MIT
#include "cli/render/annotation.h"

#include "cli/draw/text.h"
#include "cli/render/legend.h"
#include "cli/render/orientation.h"
#include "core/base/text.h"

#include <algorithm>
#include <cmath>

namespace voxtact::app {

namespace {

constexpr double kText = 13;      // pixels of an em in a picture of kPlain pixels
constexpr double kPlain = 512;    // along its shorter side
constexpr double kSmallest = 9.5; // smallest readable size
constexpr double kLargest = 64;
// In ems.
constexpr double kRow = 1.6;
constexpr double kEdge = 0.6;
constexpr double kColumn = 6;
constexpr double kCube = 5;
/// Minimum share of each side of a picture that remains for the volume.
constexpr double kMinFrame = 0.6;

/// Returns the base line of text in a row.
double baseIn(const Box2& row, double size) {
    return (row.top + row.bottom + capitalHeight(size)) / 2;
}

void drawSwatches(Canvas& canvas, const std::vector<Swatch>& swatches, const Box2& row, double size) {
    double x = row.left;
    for (std::size_t i = 0; i < swatches.size(); ++i) {
        const std::size_t rest = swatches.size() - i - 1;
        const std::string more = rest > 0 ? "+" + std::to_string(rest) : "";
        const double square = 0.8 * size;
        const double room = row.right - x - square - 1.5 * size - textWidth(more, size);
        const std::string text = shortened(swatches[i].text, size, room);
        if (text.empty()) {
            drawText(canvas, "+" + std::to_string(rest + 1), size, {x, baseIn(row, size)});
            return;
        }
        const double middle = (row.top + row.bottom) / 2;
        const Box2 box{x, middle - square / 2, x + square, middle + square / 2};
        const Colour ink = inkOn(canvas.brightness({x - size, row.top, row.right, row.bottom}));
        canvas.fill(box, swatches[i].colour);
        canvas.outline(box, std::max(1.0, size / 14), ink, 0.6);
        x += square + 0.4 * size;
        drawText(canvas, text, size, {x, baseIn(row, size)});
        x += textWidth(text, size) + size;
    }
}

/// Returns the largest 1, 2 or 5 times a power of ten up to `max`.
double niceBelow(double max) {
    const double power = std::pow(10, std::floor(std::log10(max)));
    for (const double factor : {5.0, 2.0}) {
        if (factor * power <= max) {
            return factor * power;
        }
    }
    return power;
}

void drawBar(Canvas& canvas, const Mat4& clip_from_world, const Box2& row, double size) {
    const std::optional<double> pixel = pixelSize(clip_from_world, canvas.width(), canvas.height());
    if (!pixel) {
        return;
    }
    const double length = niceBelow(std::max(row.width() / 3, 1.0) * *pixel);
    const std::string label = number(length) + " mm";
    const double right = row.left + length / *pixel;
    const double middle = (row.top + row.bottom) / 2;
    const double thick = std::max(1.5, size / 7);
    const double tick = size / 3;
    const Colour ink = inkOn(canvas.brightness({row.left, row.top, right, row.bottom}));
    const Colour rim{1 - ink[0], 1 - ink[1], 1 - ink[2]};
    for (const bool outer : {true, false}) {
        const double more = outer ? thick * 0.6 : 0;
        const Colour& colour = outer ? rim : ink;
        const double opacity = outer ? 0.6 : 1;
        canvas.fill(Box2{row.left - more, middle - thick / 2 - more, right + more, middle + thick / 2 + more}, colour,
                    opacity);
        for (const double x : {row.left, right - thick}) {
            canvas.fill(Box2{x - more, middle - tick - more, x + thick + more, middle + tick + more}, colour, opacity);
        }
    }
    drawText(canvas, label, size, {right + 0.6 * size, baseIn(row, size)});
}

void drawLetters(Canvas& canvas, const Mat4& clip_from_world, const Box2& frame, double size) {
    const std::optional<ScreenAxes> axes = screenAxes(clip_from_world);
    if (!axes) {
        return;
    }
    const Vec3& right = axes->right;
    const Vec3& up = axes->up;
    const Vec3 left{-right[0], -right[1], -right[2]};
    const Vec3 down{-up[0], -up[1], -up[2]};
    const double x = (frame.left + frame.right) / 2;
    const double y = (frame.top + frame.bottom) / 2;
    const double away = kRow * size / 2;
    const auto centred = [&](const Vec3& direction, const Point& at) {
        const std::string letters = sideLetters(direction);
        drawText(canvas, letters, size, {at.x - textWidth(letters, size) / 2, at.y + capitalHeight(size) / 2});
    };
    centred(up, {x, frame.top - away});
    centred(down, {x, frame.bottom + away});
    centred(left, {frame.left - away, y});
    centred(right, {frame.right + away, y});
}

} // namespace

AnnotationRoom roomFor(std::uint32_t width, std::uint32_t height, bool swatches, bool legend) {
    const double w = width;
    const double h = height;
    AnnotationRoom room;
    const double text = std::clamp(kText * std::min(w, h) / kPlain, kSmallest, kLargest);
    const double edge = kEdge * text;
    const double row = kRow * text;
    room.text = text;
    room.frame = {0, 0, w, h};
    const auto fits = [](double rest, double whole) { return rest >= kMinFrame * whole; };
    double wide = w;
    double high = h;
    if (fits(wide - 2 * row, w) && fits(high - 2 * row, h)) {
        room.letters = true;
        wide -= 2 * row;
        high -= 2 * row;
        room.frame = {row, row, w - row, h - row};
    }
    if (room.letters && fits(high - row - edge, h)) {
        high -= row + edge;
        room.frame.bottom -= row + edge;
        room.bar = Box2{edge, h - row - edge, w - edge, h - edge};
    }
    const double lines = swatches ? 2 : 1;
    if (room.letters && fits(high - lines * row - edge, h)) {
        high -= lines * row + edge;
        room.frame.top += lines * row + edge;
        room.title = Box2{edge, edge, w - edge, edge + row};
        if (swatches) {
            room.swatches = Box2{edge, edge + row, w - edge, edge + 2 * row};
        }
    }
    const double column = kColumn * text + edge;
    if (room.letters && fits(wide - column, w)) {
        room.frame.right -= column;
        const double left = w - column;
        const double cube = kCube * text;
        room.cube = Box2{left, h - edge - cube, left + cube, h - edge};
        if (room.bar) {
            room.bar->right = left;
        }
        if (legend) {
            room.legend = Box2{left, room.frame.top, w - edge, room.cube->top - row};
        }
    }
    return room;
}

Result<void> annotate(Picture& picture, const Annotation& annotation, const AnnotationRoom& room) {
    Canvas canvas(picture.rgba, picture.width, picture.height);
    if (room.title) {
        const std::string title = shortened(annotation.title, room.text, room.title->width());
        drawText(canvas, title, room.text, {room.title->left, baseIn(*room.title, room.text)});
    }
    if (room.swatches) {
        drawSwatches(canvas, annotation.swatches, *room.swatches, room.text);
    }
    if (room.bar) {
        drawBar(canvas, annotation.clip_from_world, *room.bar, room.text);
    }
    if (room.letters) {
        drawLetters(canvas, annotation.clip_from_world, room.frame, room.text);
    }
    if (room.cube) {
        drawCube(canvas, annotation.clip_from_world, *room.cube);
    }
    if (room.legend && annotation.legend) {
        return drawLegend(canvas, *annotation.legend, *room.legend, room.text);
    }
    return {};
}

} // namespace voxtact::app
