// SPDX-License-Identifier: MIT
#include "cli/render/legend.h"

#include "cli/draw/text.h"
#include "core/base/text.h"
#include "core/base/try.h"

#include <algorithm>
#include <cmath>

namespace voxtact::app {

namespace {

/// Returns the distance of ticks: 1, 2 or 5 times a power of ten, for at most `max` ticks.
double tickStep(const ValueRange& range, double max) {
    const double min = (range.hi - range.lo) / std::max(max, 1.0);
    const double power = std::pow(10, std::floor(std::log10(min)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= min) {
            return factor * power;
        }
    }
    return 10 * power;
}

/// Returns a channel of a legend, from the lowest value to the highest.
Result<std::vector<float>> sampled(std::span<const ControlPoint> points, const ValueRange& range, std::size_t rows) {
    return sampleTable({points, range, static_cast<std::uint32_t>(std::max<std::size_t>(rows, 2))});
}

void drawTicks(Canvas& canvas, const ValueRange& range, const Box2& ramp, double size) {
    const double step = tickStep(range, ramp.height() / (2.2 * size));
    for (double tick = std::ceil(range.lo / step); tick * step <= range.hi; ++tick) {
        const double value = tick * step;
        const double y = ramp.bottom - (value - range.lo) / (range.hi - range.lo) * ramp.height();
        const Colour ink = inkOn(canvas.brightness({ramp.right, y - size, ramp.right + 2 * size, y + size}));
        canvas.fill(Box2{ramp.right, y - 0.5, ramp.right + 0.4 * size, y + 0.5}, ink);
        const std::string label = tick == 0 ? "0" : number(value);
        drawText(canvas, label, size, {ramp.right + 0.65 * size, y + capitalHeight(size) / 2});
    }
}

} // namespace

ValueRange legendRange(const std::vector<ControlPoint>& opacity, const ValueRange& domain) {
    const auto seen = std::ranges::find_if(opacity, [](const ControlPoint& point) { return point.opacity > 0; });
    if (seen == opacity.end()) {
        return domain;
    }
    const double first = seen == opacity.begin() ? domain.lo : std::prev(seen)->value;
    const double last = opacity.back().opacity > 0 && opacity.size() == 1 ? domain.hi : opacity.back().value;
    constexpr double kMore = 0.06;
    const double lo = std::max(first, domain.lo);
    const double hi = std::min(last, domain.hi);
    if (!(lo < hi)) {
        return domain;
    }
    return {std::max(domain.lo, lo - kMore * (hi - lo)), std::min(domain.hi, hi + kMore * (hi - lo))};
}

Result<void> drawLegend(Canvas& canvas, const Legend& legend, const Box2& box, double text) {
    const double size = 0.9 * text;
    // On whole pixels: each row covers its pixels completely.
    const Box2 ramp{std::round(box.left), std::round(box.top + 1.6 * size), std::round(box.left + 1.7 * size),
                    std::round(box.bottom)};
    if (!(ramp.height() > 3 * size)) {
        return {};
    }
    const auto rows = static_cast<std::size_t>(std::lround(ramp.height()));
    const Result<std::vector<float>> opacity = sampled(legend.opacity, legend.range, rows);
    VOXTACT_TRY(opacity);
    std::array<std::vector<float>, 3> channels;
    for (std::size_t channel = 0; channel < channels.size(); ++channel) {
        std::vector<ControlPoint> points;
        for (const ColourPoint& point : legend.colours) {
            points.push_back({point.value, point.colour[channel]});
        }
        Result<std::vector<float>> table = sampled(points, legend.range, rows);
        VOXTACT_TRY(table);
        channels[channel] = std::move(*table);
    }
    drawText(canvas, legend.unit, size, {box.left, box.top + size});
    const Colour ink = inkOn(canvas.brightness(ramp));
    canvas.fill(ramp, ink, 0.12);
    const double maxOpacity = std::max(static_cast<double>(*std::ranges::max_element(*opacity)), 1e-6);
    for (std::size_t row = 0; row < rows; ++row) {
        const Colour colour{channels[0][row], channels[1][row], channels[2][row]};
        const double bottom = ramp.bottom - static_cast<double>(row);
        const double share = static_cast<double>((*opacity)[row]) / maxOpacity;
        constexpr double kHint = 0.25; // share of the colour at almost no opacity
        canvas.fill(Box2{ramp.left, bottom - 1, ramp.right, bottom}, colour, kHint);
        canvas.fill(Box2{ramp.left, bottom - 1, ramp.left + ramp.width() * share, bottom}, colour);
    }
    canvas.outline(ramp, 1, ink, 0.5);
    drawTicks(canvas, legend.range, ramp, size);
    return {};
}

} // namespace voxtact::app
