// SPDX-License-Identifier: MIT
// What opacities a range of entry coordinates has: one text for GLSL and C++. The entry coordinate of a scalar is
// x = s * N - 0.5, s being the normalised scalar and N the entries of the transfer function's table: entry i is at
// x = i. Everything errs to the side that is named: "may" is never false for what is, "certainly" never true for what
// is not.
#ifndef VOXTACT_OPACITY_RANGES_H
#define VOXTACT_OPACITY_RANGES_H

#include "exact.h"
#include "opacity_table.h"

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

/// More than the rounding of one interpolation between two opacities.
#define OPACITY_ERROR 4.76837158203125e-7f

/// The largest integer that is not above `x`, and the smallest that is not below it. Expects what fits an integer.
EXACT int wholeBelow(float x) {
    const int cut = int(x);
    return float(cut) > x ? cut - 1 : cut;
}
EXACT int wholeAbove(float x) {
    const int cut = int(x);
    return float(cut) < x ? cut + 1 : cut;
}

/// A coordinate as the table is looked up: clamped to its ends. `instead` for NaN.
EXACT float opacityEntry(OpacityTable table, float x, float instead) {
    const float last = float(table.size - 1);
    return x >= 0.0f ? (x <= last ? x : last) : (x < 0.0f ? 0.0f : instead);
}

/// The opacity at a coordinate of [0, N-1], within OPACITY_ERROR.
EXACT float opacityAt(OpacityTable table, float x) {
    const int first = wholeBelow(x);
    PRECISE float weight = x - float(first);
    const int second = first + 1 < table.size ? first + 1 : first;
    return exactLerp(opacityExtreme(table, first), opacityExtreme(table, second), weight);
}

/// Whether some coordinate of [lo, hi] may be opaque. NaN may be anything.
EXACT bool mayBeOpaque(OpacityTable table, float lo, float hi) {
#ifdef __cplusplus
    const bool some = table.bounds.some(lo, hi);
    if (some || table.bounds.none(lo, hi)) {
        return some;
    }
#endif
    const float from = opacityEntry(table, lo, 0.0f);
    const float to = opacityEntry(table, hi, float(table.size - 1));
    const int first = wholeBelow(from);
    const int last = wholeAbove(to);
    if (!(opacityMaximum(table, first, last) >= table.threshold)) {
        return false;
    }
    const int inner = wholeAbove(from);
    const int outer = wholeBelow(to);
    if (inner <= outer && opacityMaximum(table, inner, outer) >= table.threshold) {
        return true;
    }
    PRECISE float safe = table.threshold - OPACITY_ERROR;
    return opacityAt(table, from) >= safe || opacityAt(table, to) >= safe;
}

/// Whether all coordinates of [lo, hi] are certainly opaque. False with NaN.
EXACT bool certainlyAllOpaque(OpacityTable table, float lo, float hi) {
    if (!(lo <= hi)) {
        return false;
    }
#ifdef __cplusplus
    const bool all = table.bounds.all(lo, hi);
    if (all || table.bounds.none(lo, lo) || table.bounds.none(hi, hi)) {
        return all;
    }
#endif
    const float from = opacityEntry(table, lo, 0.0f);
    const float to = opacityEntry(table, hi, 0.0f);
    const int first = wholeBelow(from);
    const int last = wholeAbove(to);
    if (opacityMinimum(table, first, last) >= table.threshold) {
        return true;
    }
    const int inner = wholeAbove(from);
    const int outer = wholeBelow(to);
    if (inner <= outer && !(opacityMinimum(table, inner, outer) >= table.threshold)) {
        return false;
    }
    PRECISE float safe = table.threshold + OPACITY_ERROR;
    return opacityAt(table, from) >= safe && opacityAt(table, to) >= safe;
}

/// Whether some coordinate of [lo, hi] is certainly opaque: false for an empty range, and with NaN.
EXACT bool certainlySomeOpaque(OpacityTable table, float lo, float hi) {
    if (!(lo <= hi)) {
        return false;
    }
#ifdef __cplusplus
    const bool some = table.bounds.some(lo, hi);
    if (some || table.bounds.none(lo, hi)) {
        return some;
    }
#endif
    const float from = opacityEntry(table, lo, 0.0f);
    const float to = opacityEntry(table, hi, 0.0f);
    const int inner = wholeAbove(from);
    const int outer = wholeBelow(to);
    if (inner <= outer && opacityMaximum(table, inner, outer) >= table.threshold) {
        return true;
    }
    PRECISE float safe = table.threshold + OPACITY_ERROR;
    return opacityAt(table, from) >= safe || opacityAt(table, to) >= safe;
}

/// One of the coordinates of [lo, hi] that are certainly opaque: of the entries the one of the greatest opacity, an end
/// where none of them is opaque. Expects certainlySomeOpaque().
EXACT float opaqueBetween(OpacityTable table, float lo, float hi) {
    const float from = opacityEntry(table, lo, 0.0f);
    const float to = opacityEntry(table, hi, 0.0f);
    int inner = wholeAbove(from);
    int outer = wholeBelow(to);
    if (inner > outer || !(opacityMaximum(table, inner, outer) >= table.threshold)) {
        return opacityAt(table, from) >= opacityAt(table, to) ? lo : hi;
    }
    while (inner < outer) {
        const int middle = (inner + outer) / 2;
        if (opacityMaximum(table, inner, middle) >= opacityMaximum(table, middle + 1, outer)) {
            outer = middle;
        } else {
            inner = middle + 1;
        }
    }
    // Beyond the table its ends are looked up: the coordinate itself stays in the range.
    const float entry = float(inner);
    return entry < lo ? lo : (entry > hi ? hi : entry);
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
