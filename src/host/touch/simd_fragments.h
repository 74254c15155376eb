// SPDX-License-Identifier: MIT
// Fragments as vectors, a lane each, for one target.
#if defined(VOXTACT_CPU_SIMD_FRAGMENTS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXTACT_CPU_SIMD_FRAGMENTS_H
#undef VOXTACT_CPU_SIMD_FRAGMENTS_H
#else
#define VOXTACT_CPU_SIMD_FRAGMENTS_H
#endif

#include "host/simd_exact.h"
#include "host/touch/fragment_filter.h"

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FragmentFloats = hn::CappedTag<float, FragmentFilter::kMostLanes>;
using FragmentV = hn::Vec<FragmentFloats>;
using FragmentMask = hn::Mask<FragmentFloats>;
using FragmentWhole = hn::RebindToSigned<FragmentFloats>;
using FragmentWords = hn::RebindToUnsigned<FragmentFloats>;

HWY_INLINE FragmentV all(float value) {
    return hn::Set(FragmentFloats(), value);
}
/// Same as certifiedMin() and certifiedMax(): NaN stays if it is first.
HWY_INLINE FragmentV lesser(FragmentV a, FragmentV b) {
    return hn::IfThenElse(hn::Lt(b, a), b, a);
}
HWY_INLINE FragmentV greater(FragmentV a, FragmentV b) {
    return hn::IfThenElse(hn::Gt(b, a), b, a);
}
/// Same as certifiedClamp().
HWY_INLINE FragmentV clamped(FragmentV value, FragmentV lo, FragmentV hi) {
    return hn::IfThenElse(hn::Ge(value, lo), hn::IfThenElse(hn::Le(value, hi), value, hi), lo);
}

/// A cell along an axis, as in certifiedDomain().
struct AlongCell {
    FragmentV place; ///< of the cell's corner
    FragmentV lo;
    FragmentV hi;
    FragmentMask whole; ///< in the domain
};

HWY_INLINE AlongCell alongCell(hn::Vec<FragmentWhole> cell, std::int32_t size) {
    const FragmentFloats d;
    const FragmentWhole whole;
    const FragmentMask begins = hn::RebindMask(d, hn::Lt(cell, hn::Zero(whole)));
    const FragmentMask ends = hn::RebindMask(d, hn::Eq(cell, hn::Set(whole, size - 1)));
    return {hn::ConvertTo(d, cell), hn::IfThenElseZero(begins, all(0.5F)), hn::IfThenElse(ends, all(0.5F), all(1)),
            hn::Not(hn::Or(begins, ends))};
}

/// Same as certifiedEntry().
HWY_INLINE FragmentV entryOf(const shader::CertifiedItem& item, FragmentV stored) {
    return hn::Mul(hn::Sub(stored, all(item.storedReference)), all(item.entryScale));
}

/// The entries at the cells' corners, x + 2 y + 4 z.
using FragmentEntries = std::array<FragmentV, 8>;

/// Boxes within the cells, from the cells' corners.
struct FragmentBoxes {
    std::array<FragmentV, 3> lo;
    std::array<FragmentV, 3> hi;
};

struct FragmentRanges {
    FragmentV least;
    FragmentV greatest;
};

/// Same as certifiedBoxRange().
HWY_INLINE FragmentRanges rangesIn(const FragmentEntries& entries, const FragmentBoxes& boxes) {
    const auto side = [&](FragmentV x) {
        const FragmentV v00 = lerp(entries[0], entries[1], x);
        const FragmentV v10 = lerp(entries[2], entries[3], x);
        const FragmentV v01 = lerp(entries[4], entries[5], x);
        const FragmentV v11 = lerp(entries[6], entries[7], x);
        const FragmentV lowLow = lerp(v00, v10, boxes.lo[1]);
        const FragmentV lowHigh = lerp(v01, v11, boxes.lo[1]);
        const FragmentV highLow = lerp(v00, v10, boxes.hi[1]);
        const FragmentV highHigh = lerp(v01, v11, boxes.hi[1]);
        const FragmentV p = lerp(lowLow, lowHigh, boxes.lo[2]);
        const FragmentV q = lerp(lowLow, lowHigh, boxes.hi[2]);
        const FragmentV r = lerp(highLow, highHigh, boxes.lo[2]);
        const FragmentV s = lerp(highLow, highHigh, boxes.hi[2]);
        return FragmentRanges{lesser(lesser(p, q), lesser(r, s)), greater(greater(p, q), greater(r, s))};
    };
    const FragmentRanges low = side(boxes.lo[0]);
    const FragmentRanges high = side(boxes.hi[0]);
    return {lesser(low.least, high.least), greater(low.greatest, high.greatest)};
}

struct FragmentErrors {
    FragmentV point;  ///< as certifiedPointError()
    FragmentV margin; ///< as certifiedMargin()
};

HWY_INLINE FragmentErrors errorsOf(const shader::CertifiedItem& item, FragmentV wideLo, FragmentV wideHi,
                                   FragmentV delta) {
    const FragmentV reference = all(item.storedReference);
    const FragmentV scale = all(item.entryScale);
    const FragmentV farthest = greater(hn::Abs(hn::Sub(wideLo, reference)), hn::Abs(hn::Sub(wideHi, reference)));
    const FragmentV part = hn::Mul(hn::Mul(scale, farthest), all(CERTIFIED_VALUE_ERROR));
    const FragmentV point = hn::Add(part, all(shader::certifiedCornerError(item)));
    const FragmentV shifted = hn::Mul(hn::Sub(hn::Mul(scale, wideHi), hn::Mul(scale, wideLo)), delta);
    return {point, hn::Add(point, hn::Mul(shifted, all(8)))};
}

/// True if no value from `range.least` to `range.greatest` is opaque, with an error of `slack`.
HWY_INLINE FragmentMask noneIn(const shader::OpacityBounds& bounds, const FragmentRanges& range, FragmentV slack) {
    return hn::Or(hn::Lt(hn::Add(range.greatest, slack), all(bounds.first)),
                  hn::Gt(hn::Sub(range.least, slack), all(bounds.last)));
}
/// True if every value is opaque.
HWY_INLINE FragmentMask allIn(const shader::OpacityBounds& bounds, const FragmentRanges& range, FragmentV slack) {
    return hn::And(hn::Ge(hn::Sub(range.least, slack), all(bounds.allFirst)),
                   hn::Le(hn::Add(range.greatest, slack), all(bounds.allLast)));
}

} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#endif
