// SPDX-License-Identifier: MIT
// The extremes of a transfer function's table over runs of entries: one text for GLSL and C++.
#ifndef VOXTACT_OPACITY_TABLE_H
#define VOXTACT_OPACITY_TABLE_H

#include "exact_language.h"

#ifdef __cplusplus
#include <bit>
#include <limits>
namespace voxtact::shader {

/// What the host knows of a table, in entry coordinates: what takes some look-ups to ask of a range, for most ranges
/// takes two comparisons. Without knowing any, no range is answered by them.
struct OpacityBounds {
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    /// No range that ends before `first` or begins after `last` may be opaque, nor any part of one (mayBeOpaque()).
    float first = -kInfinity;
    float last = kInfinity;
    /// Every range within these certainly is opaque all over (certainlyAllOpaque()). Empty: no such range is known.
    float allFirst = kInfinity;
    float allLast = -kInfinity;

    /// What they say of a range: nothing in it is opaque, something is, all is. False where they do not say it, and
    /// with NaN.
    [[nodiscard]] constexpr bool none(float lo, float hi) const noexcept { return hi < first || lo > last; }
    [[nodiscard]] constexpr bool some(float lo, float hi) const noexcept { return lo <= allLast && hi >= allFirst; }
    [[nodiscard]] constexpr bool all(float lo, float hi) const noexcept { return lo >= allFirst && hi <= allLast; }
};
#endif

/// The table's extremes (core/transfer/table_extremes.h) and the threshold. In GLSL the extremes are the buffer of that
/// name.
struct OpacityTable {
    int size;
    int levels;
    float threshold;
#ifdef __cplusplus
    const float* extremes;
    OpacityBounds bounds = {};
#endif
};

EXACT float opacityExtreme(OpacityTable table, int index) {
#ifdef __cplusplus
    return table.extremes[index];
#else
    return extremes[index];
#endif
}

/// The largest opacity of the entries from `first` to `last`, which are in the table.
EXACT float opacityMaximum(OpacityTable table, int first, int last) {
#ifdef __cplusplus
    const int level = static_cast<int>(std::bit_width(static_cast<unsigned>(last - first + 1))) - 1;
#else
    const int level = findMSB(last - first + 1);
#endif
    const float head = opacityExtreme(table, level * table.size + first);
    const float tail = opacityExtreme(table, level * table.size + last + 1 - (1 << level));
    return head > tail ? head : tail;
}

/// The smallest.
EXACT float opacityMinimum(OpacityTable table, int first, int last) {
#ifdef __cplusplus
    const int level = static_cast<int>(std::bit_width(static_cast<unsigned>(last - first + 1))) - 1;
#else
    const int level = findMSB(last - first + 1);
#endif
    const int plane = (table.levels + level) * table.size;
    const float head = opacityExtreme(table, plane + first);
    const float tail = opacityExtreme(table, plane + last + 1 - (1 << level));
    return head < tail ? head : tail;
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
