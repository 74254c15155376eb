// SPDX-License-Identifier: MIT
#include "cpu/certified/opaque_hull.h"

#include <cmath>

namespace voxtact::cpu {

namespace {

/// Where the table is nearly at the threshold, a range may be called transparent that has a part which is not, and the
/// other way round: what is true of a threshold this far off is true of all parts, too.
constexpr float kNearly = 4 * OPACITY_ERROR;

shader::OpacityTable with(const shader::OpacityTable& table, float more) {
    shader::OpacityTable out = table;
    out.threshold += more;
    out.bounds = {}; // which are of another threshold
    return out;
}

/// A coordinate that is answered with yes, next to one that is not, on the way from `no` to `yes`, which are.
template <class Ask> float bisect(float no, float yes, const Ask& ask) {
    for (;;) {
        const float middle = no + (yes - no) / 2;
        if (middle == no || middle == yes) {
            return yes;
        }
        (ask(middle) ? yes : no) = middle;
    }
}

/// Entries next to each other.
struct Run {
    int first = 0;
    int last = -1;
};

/// The longest run of entries that reach the threshold.
Run longestRun(const shader::OpacityTable& table) {
    Run best;
    Run run;
    for (int entry = 0; entry < table.size; ++entry) {
        if (shader::opacityExtreme(table, entry) >= table.threshold) {
            run = {run.last == entry - 1 && run.last >= run.first ? run.first : entry, entry};
            best = run.last - run.first > best.last - best.first ? run : best;
        }
    }
    return best;
}

/// From what may be opaque to what certainly is.
bool isNear(float may, float all) {
    return may == all || std::abs(all - may) < 1;
}

void setAll(const shader::OpacityTable& table, shader::OpacityBounds& bounds) {
    const shader::OpacityTable higher = with(table, kNearly);
    const Run run = longestRun(higher);
    if (run.last < run.first) {
        return;
    }
    const auto first = static_cast<float>(run.first);
    const auto last = static_cast<float>(run.last);
    const auto all = [&](float lo, float hi) { return shader::certainlyAllOpaque(higher, lo, hi); };
    if (!all(first, last)) {
        return;
    }
    bounds.allFirst = run.first == 0 ? -shader::OpacityBounds::kInfinity
                                     : bisect(first - 1, first, [&](float at) { return all(at, last); });
    bounds.allLast = run.last == table.size - 1
                         ? shader::OpacityBounds::kInfinity
                         : bisect(last + 1, last, [&](float at) { return all(bounds.allFirst, at); });
    if (!all(bounds.allFirst, bounds.allLast)) {
        bounds.allFirst = first;
        bounds.allLast = last;
    }
}

} // namespace

OpaqueHull opaqueHullOf(const shader::OpacityTable& table) noexcept {
    OpaqueHull hull;
    shader::OpacityBounds& bounds = hull.bounds;
    bounds.first = shader::OpacityBounds::kInfinity;
    bounds.last = -shader::OpacityBounds::kInfinity;
    setAll(table, bounds);
    const shader::OpacityTable lower = with(table, -kNearly);
    const auto end = static_cast<float>(table.size - 1);
    const auto before = [&](float at) { return shader::mayBeOpaque(lower, 0, at); };
    const auto after = [&](float at) { return shader::mayBeOpaque(lower, at, end); };
    if (!before(end)) {
        return hull; // nothing is
    }
    bounds.first = before(0) ? -shader::OpacityBounds::kInfinity : bisect(0, end, before);
    bounds.last = after(end) ? shader::OpacityBounds::kInfinity : bisect(end, 0, after);
    hull.whole = bounds.allFirst <= bounds.allLast && isNear(bounds.first, bounds.allFirst) &&
                 isNear(bounds.last, bounds.allLast);
    return hull;
}

} // namespace voxtact::cpu
