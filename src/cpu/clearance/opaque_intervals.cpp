// SPDX-License-Identifier: MIT
#include "cpu/clearance/opaque_intervals.h"
#include "core/base/infinity.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

/// Of a place among so many entries: the rounding of a quotient of differences of floats, and of the sum with the
/// number of the entry.
constexpr double kPlaceError = 0x1p-50;

/// Where the line from `a` at 0 to `b` at 1, of which one is below the threshold, crosses it.
double crossing(double a, double b, double threshold) {
    return std::clamp((threshold - a) / (b - a), 0.0, 1.0);
}

} // namespace

OpaqueIntervals::OpaqueIntervals(std::span<const float> table, float threshold) {
    const auto opaque = [&](std::size_t i) { return table[i] >= threshold; };
    const auto place = [&](std::size_t i) {
        return static_cast<double>(i) + crossing(static_cast<double>(table[i]), static_cast<double>(table[i + 1]),
                                                 static_cast<double>(threshold));
    };
    const std::size_t last = table.size() - 1;
    const double error = kPlaceError * static_cast<double>(table.size());
    for (std::size_t i = 0; i <= last; ++i) {
        if (!opaque(i)) {
            continue;
        }
        const std::size_t first = i;
        while (i < last && opaque(i + 1)) {
            ++i;
        }
        const double from = first == 0 ? -kInfinity : place(first - 1);
        const double to = i == last ? kInfinity : place(i);
        outer_.push_back({from - error, to + error});
        // The entries themselves are opaque without rounding.
        inner_.push_back(
            {std::min(from + error, static_cast<double>(first)), std::max(to - error, static_cast<double>(i))});
    }
}

std::size_t OpaqueIntervals::firstEndingAt(const std::vector<EntryInterval>& in, double lo) const noexcept {
    std::size_t i = 0;
    if (in.size() > 8) {
        i = static_cast<std::size_t>(
            std::partition_point(in.begin(), in.end(), [lo](const EntryInterval& one) { return one.hi < lo; }) -
            in.begin());
    }
    while (i < in.size() && in[i].hi < lo) {
        ++i;
    }
    return i;
}

bool OpaqueIntervals::meet(double lo, double hi, EntryInterval& hull) const noexcept {
    if (!(lo <= hi)) {
        hull = {};
        return !outer_.empty();
    }
    std::size_t i = firstEndingAt(outer_, lo);
    if (i == outer_.size() || outer_[i].lo > hi) {
        return false;
    }
    hull = outer_[i];
    while (i + 1 < outer_.size() && outer_[i + 1].lo <= hi) {
        hull.hi = outer_[++i].hi;
    }
    return true;
}

OpaqueIntervals::Some OpaqueIntervals::between(double lo, double hi) const noexcept {
    if (!(lo <= hi)) {
        return {};
    }
    const std::size_t first = firstEndingAt(outer_, lo);
    std::size_t end = first;
    while (end < outer_.size() && outer_[end].lo <= hi) {
        ++end;
    }
    return {std::span(outer_).subspan(first, end - first), std::span(inner_).subspan(first, end - first), true};
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

const EntryInterval& OpaqueIntervals::nearest(double entry) const noexcept {
    const std::size_t i = firstEndingAt(inner_, entry);
    if (i == inner_.size()) {
        return inner_.back();
    }
    return i > 0 && entry - inner_[i - 1].hi < inner_[i].lo - entry ? inner_[i - 1] : inner_[i];
}

} // namespace voxtact::cpu
