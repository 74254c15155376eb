// SPDX-License-Identifier: MIT
#include "core/transfer/opaque_intervals.h"
#include "core/base/exact_difference.h"
#include "core/base/infinity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace voxtact {

namespace {

/// Bounds of an interval's end. Exact: lo == hi.
using EndPlace = ValueRange;

/// More than the relative rounding of a sum, a product and two quotients.
constexpr double kEndRounding = 0x1p-50;
constexpr double kLeastEnd = 4 * std::numeric_limits<double>::denorm_min();

bool productsAreEqual(double a, double b, double c, double d) {
    const double product = a * b;
    constexpr double kLeastExact = 0x1p-960; // smaller products lose bits
    if (std::abs(product) < kLeastExact) {
        return (a == 0 || b == 0) && (c == 0 || d == 0);
    }
    return product == c * d && std::fma(a, b, -product) == std::fma(c, d, -product);
}

/// Position between two points, one of which is opaque, at which the opacity crosses the threshold.
EndPlace crossing(const ControlPoint& a, const ControlPoint& b, double threshold) {
    for (const ControlPoint& point : {a, b}) {
        if (point.opacity == threshold || a.value == b.value) {
            return {point.value, point.value};
        }
    }
    const double way = (b.value - a.value) * ((threshold - a.opacity) / (b.opacity - a.opacity));
    const double at = std::clamp(a.value + way, a.value, b.value);
    const std::optional<double> width = exactDifference(b.value, a.value);
    const std::optional<double> rise = exactDifference(b.opacity, a.opacity);
    const std::optional<double> part = exactDifference(at, a.value);
    const std::optional<double> risen = exactDifference(threshold, a.opacity);
    if (width && rise && part && risen && productsAreEqual(*risen, *width, *part, *rise)) {
        return {at, at};
    }
    const double error = kEndRounding * (std::abs(way) + std::abs(at)) + kLeastEnd;
    return {std::max(at - error, a.value), std::min(at + error, b.value)};
}

/// Converts a value to the stored one.
double storedOf(double value, const StoredScale& by, double& error) {
    const double scaled = (value - by.intercept) / by.slope;
    if (std::isinf(scaled) && !std::isinf(value)) {
        error = kInfinity;
        return 0;
    }
    const std::optional<double> off = exactDifference(value, by.intercept);
    const bool exact = std::isinf(value) || (off && std::fma(scaled, by.slope, -*off) == 0);
    error = exact ? 0 : kEndRounding * (std::abs(value) + std::abs(by.intercept)) / std::abs(by.slope) + kLeastEnd;
    return scaled;
}

EndPlace storedOf(const EndPlace& place, const StoredScale& by) {
    EndPlace error{};
    const double lo = storedOf(place.lo, by, error.lo);
    const double hi = storedOf(place.hi, by, error.hi);
    return by.slope > 0 ? EndPlace{lo - error.lo, hi + error.hi} : EndPlace{hi - error.hi, lo + error.lo};
}

/// Adds an interval to those before it, of which it may touch the last.
void addInterval(std::vector<ValueRange>& to, const ValueRange& one) {
    if (!(one.lo <= one.hi)) {
        return; // rounding leaves nothing
    }
    if (!to.empty() && one.lo <= to.back().hi) {
        to.back().hi = std::max(to.back().hi, one.hi);
    } else {
        to.push_back(one);
    }
}

/// The first of some intervals that does not end before `lo`.
std::size_t firstEndingAt(std::span<const ValueRange> in, double lo) noexcept {
    std::size_t i = 0;
    if (in.size() > 8) {
        i = static_cast<std::size_t>(
            std::partition_point(in.begin(), in.end(), [lo](const ValueRange& one) { return one.hi < lo; }) -
            in.begin());
    }
    while (i < in.size() && in[i].hi < lo) {
        ++i;
    }
    return i;
}

/// The intervals that meet [lo, hi].
std::span<const ValueRange> meeting(std::span<const ValueRange> in, double lo, double hi) noexcept {
    const std::size_t first = firstEndingAt(in, lo);
    std::size_t end = first;
    while (end < in.size() && in[end].lo <= hi) {
        ++end;
    }
    return in.subspan(first, end - first);
}

} // namespace

OpaqueIntervals::OpaqueIntervals(std::span<const ControlPoint> points, double threshold, const StoredScale& stored) {
    std::vector<EndPlace> ends; // alternately from where and to where values are opaque
    const auto isOpaque = [threshold](const ControlPoint& point) { return point.opacity >= threshold; };
    if (isOpaque(points.front())) {
        ends.push_back({-kInfinity, -kInfinity});
    }
    for (std::size_t i = 1; i < points.size(); ++i) {
        if (isOpaque(points[i - 1]) != isOpaque(points[i])) {
            ends.push_back(crossing(points[i - 1], points[i], threshold));
        }
    }
    if (ends.size() % 2 != 0) {
        ends.push_back({kInfinity, kInfinity});
    }
    for (EndPlace& end : ends) {
        end = storedOf(end, stored);
    }
    if (stored.slope < 0) {
        std::reverse(ends.begin(), ends.end());
    }
    for (std::size_t i = 0; i < ends.size(); i += 2) {
        addInterval(outer_, {ends[i].lo, ends[i + 1].hi});
        addInterval(inner_, {ends[i].hi, ends[i + 1].lo});
    }
}

bool OpaqueIntervals::meet(double lo, double hi, ValueRange& hull) const noexcept {
    if (!(lo <= hi)) {
        hull = {-kInfinity, kInfinity};
        return !outer_.empty();
    }
    const std::span<const ValueRange> some = meeting(outer_, lo, hi);
    if (some.empty()) {
        return false;
    }
    hull = {some.front().lo, some.back().hi};
    return true;
}

bool OpaqueIntervals::mayMeet(double lo, double hi) const noexcept {
    ValueRange hull;
    return meet(lo, hi, hull);
}

OpaqueIntervals::Some OpaqueIntervals::between(double lo, double hi) const noexcept {
    if (!(lo <= hi)) {
        return {};
    }
    return {meeting(outer_, lo, hi), meeting(inner_, lo, hi), true};
}

bool OpaqueIntervals::contain(double lo, double hi) const noexcept {
    if (!(lo <= hi)) {
        return false;
    }
    const std::size_t i = firstEndingAt(inner_, lo);
    return i < inner_.size() && inner_[i].lo <= lo && hi <= inner_[i].hi;
}

bool OpaqueIntervals::certainlyMeet(double lo, double hi) const noexcept {
    if (!(lo <= hi)) {
        return false;
    }
    const std::size_t i = firstEndingAt(inner_, lo);
    return i < inner_.size() && inner_[i].lo <= hi;
}

const ValueRange& OpaqueIntervals::nearest(double value) const noexcept {
    const std::size_t i = firstEndingAt(inner_, value);
    if (i == inner_.size()) {
        return inner_.back();
    }
    return i > 0 && value - inner_[i - 1].hi < inner_[i].lo - value ? inner_[i - 1] : inner_[i];
}

} // namespace voxtact
