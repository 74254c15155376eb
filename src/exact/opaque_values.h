// SPDX-License-Identifier: MIT
// Which values are opaque, decided by intervals: one text for GLSL and C++. An entry is a stored value in the
// coordinate of CertifiedItem (shared.h). Everything errs to the side that is named: "may" is never false for what is,
// "certainly" never true for what is not.
#ifndef VOXTACT_OPAQUE_VALUES_H
#define VOXTACT_OPAQUE_VALUES_H

#include "exact.h"

#include "exact_language.h"

#ifdef __cplusplus
#include <limits>
namespace voxtact::shader {

/// Facts about the intervals, computed on the host: most queries about a range then take two comparisons.
struct OpacityBounds {
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    /// No value before `first` or after `last` may be opaque.
    float first = -kInfinity;
    float last = kInfinity;
    /// The longest completely opaque interval; empty if there is none.
    float allFirst = kInfinity;
    float allLast = -kInfinity;

    /// Their answers about a range: none, some or all of it is opaque. False if unknown, and for NaN.
    [[nodiscard]] constexpr bool none(float lo, float hi) const noexcept { return hi < first || lo > last; }
    [[nodiscard]] constexpr bool some(float lo, float hi) const noexcept { return lo <= allLast && hi >= allFirst; }
    [[nodiscard]] constexpr bool all(float lo, float hi) const noexcept { return lo >= allFirst && hi <= allLast; }
};
#endif

/// Closed intervals of entries, ascending and disjoint, and the control points of the function
/// (core/transfer/opaque_numbers.h).
struct OpaqueValues {
    int outer;  // outer intervals, which contain all opaque entries
    int inner;  // inner intervals, completely opaque
    int points; // of the function
    float threshold;
#ifdef __cplusplus
    const float* numbers; ///< the ends of the outer intervals, of the inner ones, and of each point: entry, opacity
    OpacityBounds bounds = {};
#endif
};

#ifdef __cplusplus
EXACT float opaqueNumber(OpaqueValues values, int index) {
    return values.numbers[index];
}
#else
float opaqueNumber(OpaqueValues values, int index); // the program's
#endif

/// A step of a search: skips `steps` intervals that end before `lo`.
#define OPAQUE_STEP(steps)                                                                                             \
    if (from + (steps) <= count && opaqueNumber(values, 2 * (first + from + (steps)-1) + 1) < lo) {                    \
        from += (steps);                                                                                               \
    }

/// The first of `count` intervals, on a device at most 4095, from the pair `first` on that does not end before `lo`;
/// `count` where there is none. Without a loop: llvmpipe ends all loops of a program after 65,535 rounds together.
EXACT int opaqueIntervalAt(OpaqueValues values, int first, int count, float lo) {
    int from = 0;
#ifdef __cplusplus
    for (int steps = 1 << 28; steps > 2048; steps /= 2) {
        OPAQUE_STEP(steps)
    }
#endif
    if (count >= 16) {
        OPAQUE_STEP(2048)
        OPAQUE_STEP(1024)
        OPAQUE_STEP(512)
        OPAQUE_STEP(256)
        OPAQUE_STEP(128)
        OPAQUE_STEP(64)
        OPAQUE_STEP(32)
        OPAQUE_STEP(16)
    }
    OPAQUE_STEP(8)
    OPAQUE_STEP(4)
    OPAQUE_STEP(2)
    OPAQUE_STEP(1)
    return from;
}
#undef OPAQUE_STEP

/// Returns true if an entry of [lo, hi] may be opaque; NaN may.
EXACT bool mayBeOpaque(OpaqueValues values, float lo, float hi) {
#ifdef __cplusplus
    if (values.bounds.none(lo, hi)) {
        return false;
    }
    if (values.outer == 1 || values.bounds.some(lo, hi)) {
        return true;
    }
#endif
    const int at = opaqueIntervalAt(values, 0, values.outer, lo);
    return at < values.outer && !(opaqueNumber(values, 2 * at) > hi);
}

/// Returns true if all entries of [lo, hi] are certainly opaque; false for NaN.
EXACT bool certainlyAllOpaque(OpaqueValues values, float lo, float hi) {
#ifdef __cplusplus
    if (values.inner <= 1 || values.bounds.all(lo, hi)) {
        return lo <= hi && values.bounds.all(lo, hi);
    }
#endif
    const int at = opaqueIntervalAt(values, values.outer, values.inner, lo);
    return lo <= hi && at < values.inner && opaqueNumber(values, 2 * (values.outer + at)) <= lo &&
           hi <= opaqueNumber(values, 2 * (values.outer + at) + 1);
}

/// Returns true if an entry of [lo, hi] is certainly opaque; false for an empty range and for NaN.
EXACT bool certainlySomeOpaque(OpaqueValues values, float lo, float hi) {
#ifdef __cplusplus
    if (values.inner <= 1 || values.bounds.some(lo, hi)) {
        return lo <= hi && values.bounds.some(lo, hi);
    }
#endif
    const int at = opaqueIntervalAt(values, values.outer, values.inner, lo);
    return lo <= hi && at < values.inner && opaqueNumber(values, 2 * (values.outer + at)) <= hi;
}

/// Returns the first certainly opaque entry from `lo` on. Expects that there is one.
EXACT float opaqueFrom(OpaqueValues values, float lo) {
    const int at = opaqueIntervalAt(values, values.outer, values.inner, lo);
    const float first = opaqueNumber(values, 2 * (values.outer + at));
    return first > lo ? first : lo;
}

/// The opacity of an entry that is certainly opaque, up to rounding: no less than the threshold.
EXACT float opacityOfOpaque(OpaqueValues values, float entry) {
    const int first = values.outer + values.inner;
    int from = 0;
    int to = values.points;
    while (from < to) {
        const int middle = (from + to) / 2;
        if (opaqueNumber(values, 2 * (first + middle)) <= entry) {
            from = middle + 1;
        } else {
            to = middle;
        }
    }
    const int before = 2 * (first + (from > 0 ? from - 1 : 0));
    const int after = 2 * (first + (from < values.points ? from : values.points - 1));
    const float start = opaqueNumber(values, before);
    PRECISE float width = opaqueNumber(values, after) - start;
    PRECISE float part = entry - start;
    PRECISE float weight = width > 0.0f ? part * exactReciprocal(width) : 0.0f;
    float opacity = exactLerp(opaqueNumber(values, before + 1), opaqueNumber(values, after + 1), weight);
    // At a step the greatest opacity counts.
    for (int i = from - 1; i >= 0 && opaqueNumber(values, 2 * (first + i)) == entry; --i) {
        const float there = opaqueNumber(values, 2 * (first + i) + 1);
        opacity = there > opacity ? there : opacity;
    }
    // The negated comparison: extreme points have no weight.
    return !(opacity >= values.threshold) ? values.threshold : (opacity <= 1.0f ? opacity : 1.0f);
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
