// SPDX-License-Identifier: MIT
#include "viewer/model/document/curve.h"

#include <algorithm>
#include <cmath>

namespace voxtact::view {

namespace {

constexpr double kSteps = 1000;

/// Returns a decimal step that divides `width` into 1000 to 10000.
double decimalStep(double width) {
    return std::pow(10, std::floor(std::log10(width / kSteps)));
}

double roundedTo(double value, double step) {
    // Divided where it can be: 3 / 10 is 0.3, and 3 * 0.1 is not.
    return step < 1 ? std::round(value / step) / std::round(1 / step) : std::round(value / step) * step;
}

void append(std::vector<ValueRange>& ranges, const ValueRange& range) {
    if (!ranges.empty() && range.lo <= ranges.back().hi) {
        ranges.back().hi = std::max(ranges.back().hi, range.hi);
    } else {
        ranges.push_back(range);
    }
}

/// The part of a straight piece that is at or above the threshold.
void appendPiece(std::vector<ValueRange>& ranges, const ControlPoint& a, const ControlPoint& b, double threshold) {
    if (a.value > b.value || std::max(a.opacity, b.opacity) < threshold) {
        return;
    }
    const double rise = b.opacity - a.opacity;
    const double at = rise == 0 ? a.value : a.value + (threshold - a.opacity) / rise * (b.value - a.value);
    append(ranges, {a.opacity >= threshold ? a.value : at, b.opacity >= threshold ? b.value : at});
}

} // namespace

bool sameCurve(const Curve& a, const Curve& b) noexcept {
    return std::ranges::equal(a, b, [](const ControlPoint& one, const ControlPoint& other) {
        return one.value == other.value && one.opacity == other.opacity;
    });
}

bool sameColours(const std::vector<ColourPoint>& a, const std::vector<ColourPoint>& b) noexcept {
    return std::ranges::equal(a, b, [](const ColourPoint& one, const ColourPoint& other) {
        return one.value == other.value && one.colour == other.colour;
    });
}

double opacityAt(const Curve& curve, double value) noexcept {
    const auto next = std::ranges::find_if(curve, [value](const ControlPoint& point) { return point.value > value; });
    if (next == curve.begin()) {
        return curve.empty() ? 0 : curve.front().opacity;
    }
    if (next == curve.end()) {
        return curve.back().opacity;
    }
    const ControlPoint& before = *(next - 1);
    const double share = (value - before.value) / (next->value - before.value);
    return before.opacity + share * (next->opacity - before.opacity);
}

std::size_t addPoint(Curve& curve, const ControlPoint& point) {
    const auto next =
        std::ranges::find_if(curve, [&point](const ControlPoint& one) { return one.value > point.value; });
    const auto at = curve.insert(next, {point.value, std::clamp(point.opacity, 0.0, 1.0)});
    return static_cast<std::size_t>(at - curve.begin());
}

void movePoint(Curve& curve, std::size_t number, const ControlPoint& to, const ValueRange& domain) noexcept {
    const double lo = number == 0 ? std::min(domain.lo, curve[number].value) : curve[number - 1].value;
    const bool last = number + 1 == curve.size();
    const double hi = last ? std::max(domain.hi, curve[number].value) : curve[number + 1].value;
    curve[number] = {std::clamp(to.value, lo, std::max(lo, hi)), std::clamp(to.opacity, 0.0, 1.0)};
}

bool removePoint(Curve& curve, std::size_t number) {
    if (curve.size() < 2 || number >= curve.size()) {
        return false;
    }
    curve.erase(curve.begin() + static_cast<std::ptrdiff_t>(number));
    return true;
}

ControlPoint rounded(const ControlPoint& point, const ValueRange& domain) noexcept {
    return {roundedTo(point.value, decimalStep(domain.hi - domain.lo)), roundedTo(point.opacity, 1 / kSteps)};
}

std::vector<ValueRange> opaqueRanges(const Curve& curve, double threshold, const ValueRange& domain) {
    std::vector<ValueRange> ranges;
    if (curve.empty()) {
        return ranges;
    }
    appendPiece(ranges, {domain.lo, curve.front().opacity}, curve.front(), threshold);
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
        appendPiece(ranges, curve[i], curve[i + 1], threshold);
    }
    appendPiece(ranges, curve.back(), {domain.hi, curve.back().opacity}, threshold);
    return ranges;
}

} // namespace voxtact::view
