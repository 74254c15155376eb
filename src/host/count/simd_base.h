// SPDX-License-Identifier: MIT
// Names and the parts of the exact arithmetic that several stages need, for one target.
#if defined(VOXTACT_CPU_SIMD_BASE_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXTACT_CPU_SIMD_BASE_H
#undef VOXTACT_CPU_SIMD_BASE_H
#else
#define VOXTACT_CPU_SIMD_BASE_H
#endif

#include "host/count/scratch.h"
#include "host/simd_exact.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kMaxLanes>;
using Ints = hn::RebindToSigned<Floats>;
using FloatV = hn::Vec<Floats>;
using IntV = hn::Vec<Ints>;

/// exactPlaneAt()
template <class V> HWY_INLINE V planeAt(V base, V u, V v, V weight1, V weight2) {
    return hn::Add(hn::Add(base, hn::Mul(weight1, u)), hn::Mul(weight2, v));
}

} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#endif
