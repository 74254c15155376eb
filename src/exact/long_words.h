// SPDX-License-Identifier: MIT
// Whole numbers of 64 bits by two words, for shaders. One text for GLSL and C++, where tests compare it with
// std::int64_t.
#ifndef VOXTACT_LONG_WORDS_H
#define VOXTACT_LONG_WORDS_H

#include "shared.h"

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader::words {
inline void imulExtended(int a, int b, int& high, int& low) {
    const std::int64_t product = std::int64_t{a} * b;
    high = static_cast<int>(product >> 32);
    low = static_cast<int>(product);
}
#endif

/// Two's complement.
struct Long {
    int high;
    uint low;
};

EXACT Long longOf(int high, uint low) {
    Long result;
    result.high = high;
    result.low = low;
    return result;
}

EXACT uint longLow(Long a) {
    return a.low;
}

EXACT uint longHigh(Long a) {
    return uint(a.high);
}

EXACT Long longProduct(int a, int b) {
    int high;
    int low;
    imulExtended(a, b, high, low);
    return longOf(high, uint(low));
}

/// Expects that it fits.
EXACT Long longSum(Long a, int b) {
    const uint low = a.low + uint(b);
    return longOf(a.high + (b >> 31) + (low < a.low ? 1 : 0), low);
}

/// Expects that it fits.
EXACT Long longDifference(Long a, Long b) {
    return longOf(a.high - b.high - (a.low < b.low ? 1 : 0), a.low - b.low);
}

EXACT bool longIsNegative(Long a) {
    return a.high < 0;
}

/// The nearest float, ties to even. Expects at most 2^49 in size: the two parts are floats then, and only their sum is
/// rounded.
EXACT float longToFloat(Long a) {
    const int middle = 1 << 24;
    const Long raised = longSum(a, middle);
    const int above = int((uint(raised.high) << 7) | (raised.low >> 25));
    const int below = int(raised.low & 0x1ffffffu) - middle;
    PRECISE float first = float(above) * 33554432.0f; // 2^25
    PRECISE float sum = first + float(below);
    return sum;
}

#ifdef __cplusplus
} // namespace voxtact::shader::words
#endif

#include "exact_language.h"

#endif
