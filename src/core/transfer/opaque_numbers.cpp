// SPDX-License-Identifier: MIT
#include "core/transfer/opaque_numbers.h"
#include "core/base/exact_difference.h"
#include "core/base/infinity.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact {

namespace {

constexpr float kFloatInfinity = shader::OpacityBounds::kInfinity;
/// Sums of some entries of any floats are finite.
constexpr float kFloatScale = 0x1p-8F;
/// Devices take smaller entries for zero.
constexpr double kLeastNonzeroEntry = 0x1p-100;

float floatBelow(double value) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    if (value < -static_cast<double>(kLargest)) {
        return -kFloatInfinity;
    }
    if (std::isinf(value)) {
        return kFloatInfinity;
    }
    if (value > static_cast<double>(kLargest)) {
        return kLargest;
    }
    const auto rounded = static_cast<float>(value);
    return static_cast<double>(rounded) > value ? std::nextafter(rounded, -kFloatInfinity) : rounded;
}

float floatAbove(double value) {
    return -floatBelow(-value);
}

/// The end whose value has the smallest magnitude: entries near it are most exact.
float referenceOf(const OpaqueIntervals& intervals, const StoredScale& stored, bool whole) {
    double best = 0;
    double least = kInfinity;
    for (const ValueRange& one : intervals.outer()) {
        for (const double end : {one.lo, one.hi}) {
            const double size = std::abs(stored.slope * end + stored.intercept);
            if (size < least) {
                least = size;
                best = end;
            }
        }
    }
    if (whole) {
        return static_cast<float>(std::round(std::clamp(best, -0x1p17, 0x1p17))); // their difference is exact
    }
    return std::abs(best) > 0x1p-60 && std::abs(best) < 0x1p100 ? static_cast<float>(best) : 0;
}

/// Converts stored values to entries.
class EntryScale {
  public:
    EntryScale(const OpaqueNumbers& numbers, bool whole)
        : scale_(static_cast<double>(numbers.scale)), reference_(static_cast<double>(numbers.reference)),
          whole_(whole) {}

    [[nodiscard]] double of(double stored) const { return (stored - reference_) * scale_; }
    /// Holds it.
    [[nodiscard]] ValueRange around(double stored) const {
        const double entry = of(stored);
        if (std::isinf(stored) || stored == reference_) {
            return {entry, entry};
        }
        double error = exactDifference(stored, reference_) ? 0 : 0x1p-52 * std::abs(entry);
        if (!whole_ && std::abs(entry) < kLeastNonzeroEntry) {
            error += kLeastNonzeroEntry;
        }
        return {entry - error, entry + error};
    }
    /// The last float of an inner interval whose end is at `stored`, in the direction of its middle.
    [[nodiscard]] float inner(double stored, float rounded, float towards) const {
        // Differences of floats are rounded, to the end for some that are beyond it.
        const bool exact = whole_ || reference_ == 0 || stored == reference_ || std::isinf(stored);
        return exact ? rounded : std::nextafter(rounded, towards);
    }

  private:
    double scale_;
    double reference_;
    bool whole_;
};

void setOpaqueBounds(OpaqueNumbers& out) {
    shader::OpacityBounds& bounds = out.counts.bounds;
    const int outer = out.counts.outer;
    bounds.first = kFloatInfinity;
    bounds.last = -kFloatInfinity;
    if (outer > 0) {
        bounds.first = out.numbers.front();
        bounds.last = out.numbers[2 * static_cast<std::size_t>(outer) - 1];
    }
    for (int i = 0; i < out.counts.inner; ++i) {
        const float* const ends = out.numbers.data() + 2 * (outer + i);
        if (i == 0 || !(ends[1] - ends[0] < bounds.allLast - bounds.allFirst)) {
            bounds.allFirst = ends[0];
            bounds.allLast = ends[1];
        }
    }
}

} // namespace

OpaqueNumbers opaqueNumbers(std::span<const ControlPoint> points, double threshold, const StoredScale& stored,
                            bool whole) {
    const OpaqueIntervals intervals(points, threshold, stored);
    OpaqueNumbers out;
    out.scale = whole ? 1 : kFloatScale;
    out.reference = referenceOf(intervals, stored, whole);
    const EntryScale entries(out, whole);
    const auto add = [&](int& count, float lo, float hi) {
        if (lo <= hi) {
            out.numbers.insert(out.numbers.end(), {lo, hi});
            ++count;
        }
    };
    for (const ValueRange& one : intervals.outer()) {
        const float lo = floatBelow(entries.around(one.lo).lo);
        const float hi = floatAbove(entries.around(one.hi).hi);
        if (out.counts.outer > 0 && lo <= out.numbers.back()) {
            out.numbers.back() = hi;
        } else {
            add(out.counts.outer, lo, hi);
        }
    }
    for (const ValueRange& one : intervals.inner()) {
        const float lo = entries.inner(one.lo, floatAbove(entries.around(one.lo).hi), kFloatInfinity);
        const float hi = entries.inner(one.hi, floatBelow(entries.around(one.hi).lo), -kFloatInfinity);
        add(out.counts.inner, lo, hi);
    }
    for (const ControlPoint& point : points) {
        const double entry = entries.of((point.value - stored.intercept) / stored.slope);
        const auto number = static_cast<float>(std::clamp(entry, -0x1p120, 0x1p120));
        out.numbers.insert(out.numbers.end(), {number, static_cast<float>(point.opacity)});
    }
    if (stored.slope < 0) { // the points ascend, too
        const auto first = out.numbers.end() - 2 * static_cast<std::ptrdiff_t>(points.size());
        std::reverse(first, out.numbers.end());
        for (auto at = first; at != out.numbers.end(); at += 2) {
            std::iter_swap(at, at + 1);
        }
    }
    out.counts.points = static_cast<int>(points.size());
    out.counts.threshold = static_cast<float>(threshold);
    setOpaqueBounds(out);
    return out;
}

} // namespace voxtact
