// SPDX-License-Identifier: MIT
#include "host/count/row_spans.h"

#include <algorithm>

namespace voxtact::cpu {

namespace {

/// Rounds down, also below zero. `divisor` is positive.
std::int64_t floorDivide(std::int64_t value, std::int64_t divisor) {
    const std::int64_t quotient = value / divisor;
    return quotient - (value % divisor < 0 ? 1 : 0);
}

PixelEdge pixelEdge(int ax, int ay, int bx, int by, int px, int py) {
    return {shader::exactEdge(ax, ay, bx, by, px, py), -std::int64_t{by - ay} * EXACT_SUBPIXEL,
            std::int64_t{bx - ax} * EXACT_SUBPIXEL, shader::exactBias(ax, ay, bx, by)};
}

} // namespace

RowSpans::RowSpans(const shader::ExactTriangle& triangle) noexcept
    : columns_(triangle.maxX - triangle.minX + 1), rows_(triangle.maxY - triangle.minY + 1) {
    const int px = triangle.minX * EXACT_SUBPIXEL + EXACT_SUBPIXEL / 2;
    const int py = triangle.minY * EXACT_SUBPIXEL + EXACT_SUBPIXEL / 2;
    edges_[0] = pixelEdge(triangle.x1, triangle.y1, triangle.x2, triangle.y2, px, py);
    edges_[1] = pixelEdge(triangle.x2, triangle.y2, triangle.x0, triangle.y0, px, py);
    edges_[2] = pixelEdge(triangle.x0, triangle.y0, triangle.x1, triangle.y1, px, py);
}

RowSpan RowSpans::span(std::int32_t row) const noexcept {
    std::int64_t first = 0;
    std::int64_t last = columns_ - 1;
    for (const PixelEdge& edge : edges_) {
        const std::int64_t at = edge.value + row * edge.stepY + edge.bias;
        if (edge.stepX > 0) {
            first = std::max(first, -floorDivide(at, edge.stepX));
        } else if (edge.stepX < 0) {
            last = std::min(last, floorDivide(at, -edge.stepX));
        } else if (at < 0) {
            return {0, -1};
        }
    }
    return {static_cast<std::int32_t>(first), static_cast<std::int32_t>(std::max(last, first - 1))};
}

} // namespace voxtact::cpu
