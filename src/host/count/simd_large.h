// SPDX-License-Identifier: MIT
// Large and clipped triangles, one at a time: exact spans of rows, pixels of a span in lanes.
#if defined(VOXTACT_CPU_SIMD_LARGE_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXTACT_CPU_SIMD_LARGE_H
#undef VOXTACT_CPU_SIMD_LARGE_H
#else
#define VOXTACT_CPU_SIMD_LARGE_H
#endif

#include "host/count/lone_triangle.h"
#include "host/count/simd_sample.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {

/// An edge function's values along a row as floats, each rounded once: they are exact in double.
HWY_INLINE FloatV edgeFloats(double first, double step) {
    const Floats d;
#if HWY_TARGET == HWY_SCALAR
    (void)step;
    return hn::Set(d, static_cast<float>(first));
#else
    const hn::Repartition<double, Floats> doubles;
    const hn::Rebind<float, decltype(doubles)> halfFloats;
    const auto steps = hn::Set(doubles, step);
    const auto lower = hn::Iota(doubles, 0.0);
    const auto upper = hn::Add(lower, hn::Set(doubles, static_cast<double>(hn::Lanes(doubles))));
    const auto base = hn::Set(doubles, first);
    const auto low = hn::DemoteTo(halfFloats, hn::Add(base, hn::Mul(lower, steps)));
    const auto high = hn::DemoteTo(halfFloats, hn::Add(base, hn::Mul(upper, steps)));
    return hn::Combine(d, high, low);
#endif
}

/// A row of a triangle; `span` is not empty.
template <class Kept>
HWY_INLINE std::size_t shadeSpan(const Sampler<Kept>& sampler, const shader::ExactTriangle& triangle,
                                 const RowSpans& spans, std::int32_t row, const RowSpan& span) {
    const Floats d;
    const auto lanes = static_cast<std::int32_t>(hn::Lanes(d));
    const FloatV rcpArea = hn::Set(d, triangle.rcpArea);
    const auto weight = [&](const PixelEdge& edge, std::int32_t column) {
        const std::int64_t first = edge.value + row * edge.stepY + column * edge.stepX;
        return hn::Mul(edgeFloats(static_cast<double>(first), static_cast<double>(edge.stepX)), rcpArea);
    };
    const auto at = [&](float base, float u, float v, FloatV weight1, FloatV weight2) {
        return planeAt(hn::Set(d, base), hn::Set(d, u), hn::Set(d, v), weight1, weight2);
    };
    std::size_t survivors = 0;
    for (std::int32_t column = span.first; column <= span.last; column += lanes) {
        const FloatV weight1 = weight(spans.edge(1), column);
        const FloatV weight2 = weight(spans.edge(2), column);
        FloatV x = at(triangle.tx, triangle.ux, triangle.vx, weight1, weight2);
        FloatV y = at(triangle.ty, triangle.uy, triangle.vy, weight1, weight2);
        FloatV z = at(triangle.tz, triangle.uz, triangle.vz, weight1, weight2);
        if (!triangle.affine) {
            const FloatV w = reciprocal(d, at(triangle.q0, triangle.q1q0, triangle.q2q0, weight1, weight2));
            x = hn::Mul(x, w);
            y = hn::Mul(y, w);
            z = hn::Mul(z, w);
        }
        const FloatM live = hn::FirstN(d, static_cast<std::size_t>(span.last - column + 1));
        survivors += sampler.survivors(x, y, z, live);
    }
    return survivors;
}

/// One triangle after set-up.
template <class Kept>
HWY_INLINE std::size_t rasteriseLarge(const PairJob& job, const Sampler<Kept>& sampler, bool certain,
                                      const shader::ExactTriangle& triangle) {
    BrickClass found = kOpaqueBrick;
    if (!certain) {
        found = triangleClass(job, triangle);
    }
    if (found == kClearBrick) {
        return 0;
    }
    const RowSpans spans(triangle);
    std::size_t survivors = 0;
    for (std::int32_t row = 0; row < spans.rows(); ++row) {
        const RowSpan span = spans.span(row);
        if (span.last < span.first) {
            continue;
        }
        survivors += found == kOpaqueBrick ? static_cast<std::size_t>(span.last - span.first + 1)
                                           : shadeSpan(sampler, triangle, spans, row, span);
        if ((job.stopAtFirst && survivors > 0) || isCancelled(job.cancel)) {
            break;
        }
    }
    return survivors;
}

template <class Kept>
HWY_INLINE std::size_t rasteriseLone(const PairJob& job, const Sampler<Kept>& sampler, bool certain,
                                     const LoneTriangle& lone) {
    shader::ExactTriangle triangles[EXACT_MAX_CORNERS];
    const std::size_t count = setUpLone(job, lone, triangles);
    std::size_t survivors = 0;
    for (std::size_t i = 0; i < count; ++i) {
        survivors += rasteriseLarge(job, sampler, certain, triangles[i]);
    }
    return survivors;
}

} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#endif
