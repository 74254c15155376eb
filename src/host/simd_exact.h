// SPDX-License-Identifier: MIT
// The parts of exact.h that several rooms need as vectors, for one target.
#if defined(VOXTACT_CPU_SIMD_EXACT_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXTACT_CPU_SIMD_EXACT_H
#undef VOXTACT_CPU_SIMD_EXACT_H
#else
#define VOXTACT_CPU_SIMD_EXACT_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// a + weight * difference, as exactLerp().
template <class V> HWY_INLINE V lerp(V a, V b, V weight) {
    return hn::Add(a, hn::Mul(weight, hn::Sub(b, a)));
}

/// exactReciprocal()
template <class D, class V = hn::Vec<D>> HWY_INLINE V reciprocal(D d, V value) {
    const hn::RebindToSigned<D> ints;
    const V magnitude = hn::Abs(value);
    V guess = hn::BitCast(d, hn::Sub(hn::Set(ints, 0x7ef311c7), hn::BitCast(ints, magnitude)));
    const V two = hn::Set(d, 2.0F);
    for (int step = 0; step < 4; ++step) {
        guess = hn::Mul(guess, hn::Sub(two, hn::Mul(magnitude, guess)));
    }
    return hn::Or(guess, hn::And(value, hn::SignBit(d)));
}

} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#endif
