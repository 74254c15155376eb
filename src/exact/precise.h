// SPDX-License-Identifier: MIT
// Sums of two floats, by transformations that lose nothing (Knuth's sum; Dekker, "A floating-point technique for
// extending the available precision", 1971). One text for GLSL and C++; every operation is a single-precision addition
// or multiplication.
#ifndef VOXTACT_PRECISE_H
#define VOXTACT_PRECISE_H

#include "exact.h"

/// A smaller product of floats may lose flushed bits: up to this much.
#define PRECISE_LEAST_PRODUCT 8.470329472543003e-22f

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

/// high + low; |low| is at most half a unit in the last place of `high`.
struct PreciseTwo {
    float high, low;
};

EXACT PreciseTwo preciseTwo(float high, float low) {
    PreciseTwo two;
    two.high = high;
    two.low = low;
    return two;
}

/// a + b, exactly.
EXACT PreciseTwo preciseSum(float a, float b) {
    PRECISE float sum = a + b;
    PRECISE float ofB = sum - a;
    PRECISE float ofA = sum - ofB;
    PRECISE float lostB = b - ofB;
    PRECISE float lostA = a - ofA;
    PRECISE float lost = lostA + lostB;
    return preciseTwo(sum, lost);
}

/// Like preciseSum(), for |a| >= |b|.
EXACT PreciseTwo preciseQuickSum(float a, float b) {
    PRECISE float sum = a + b;
    PRECISE float ofB = sum - a;
    PRECISE float lost = b - ofB;
    return preciseTwo(sum, lost);
}

/// The first 12 bits of a float, and the others.
EXACT PreciseTwo preciseHalves(float a) {
    PRECISE float shifted = 4097.0f * a;
    PRECISE float beyond = shifted - a;
    PRECISE float high = shifted - beyond;
    PRECISE float low = a - high;
    return preciseTwo(high, low);
}

/// a * b, exactly where the product is zero or at least PRECISE_LEAST_PRODUCT, and finite.
EXACT PreciseTwo preciseProduct(float a, float b) {
    const PreciseTwo ofA = preciseHalves(a);
    const PreciseTwo ofB = preciseHalves(b);
    PRECISE float product = a * b;
    PRECISE float highs = ofA.high * ofB.high;
    PRECISE float highLow = ofA.high * ofB.low;
    PRECISE float lowHigh = ofA.low * ofB.high;
    PRECISE float lows = ofA.low * ofB.low;
    PRECISE float first = highs - product;
    PRECISE float second = first + highLow;
    PRECISE float third = second + lowHigh;
    PRECISE float lost = third + lows;
    return preciseTwo(product, lost);
}

// Operations on pairs of floats, with errors of a few units of 2^-48 of the terms.

EXACT PreciseTwo precisePlus(PreciseTwo a, PreciseTwo b) {
    const PreciseTwo highs = preciseSum(a.high, b.high);
    PRECISE float lows = a.low + b.low;
    PRECISE float low = highs.low + lows;
    return preciseQuickSum(highs.high, low);
}

EXACT PreciseTwo preciseMinus(PreciseTwo a, PreciseTwo b) {
    return precisePlus(a, preciseTwo(-b.high, -b.low));
}

EXACT PreciseTwo preciseTimes(PreciseTwo a, PreciseTwo b) {
    const PreciseTwo product = preciseProduct(a.high, b.high);
    PRECISE float highLow = a.high * b.low;
    PRECISE float lowHigh = a.low * b.high;
    PRECISE float cross = highLow + lowHigh;
    PRECISE float low = product.low + cross;
    return preciseQuickSum(product.high, low);
}

EXACT PreciseTwo preciseOver(PreciseTwo a, PreciseTwo b) {
    const float reciprocal = exactReciprocal(b.high);
    PRECISE float first = a.high * reciprocal;
    const PreciseTwo rest = preciseMinus(a, preciseTimes(preciseTwo(first, 0.0f), b));
    PRECISE float second = rest.high * reciprocal;
    return preciseQuickSum(first, second);
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
