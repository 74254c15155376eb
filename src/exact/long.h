// SPDX-License-Identifier: MIT
// Whole numbers of 64 bits, the same in C++, where they are std::int64_t, and in GLSL, where two words make them: many
// GPUs have no shaderInt64. There is what edge functions need, and what tests of that do.
#ifndef VOXTACT_LONG_H
#define VOXTACT_LONG_H

#ifdef __cplusplus
#include "shared.h"

#include <cstdint>

namespace voxtact::shader {

using Long = std::int64_t;

inline Long longOf(int high, uint low) {
    return Long{high} * (Long{1} << 32) + low;
}
inline uint longLow(Long a) {
    return static_cast<uint>(a);
}
inline uint longHigh(Long a) {
    return static_cast<uint>(a >> 32);
}
inline Long longProduct(int a, int b) {
    return Long{a} * b;
}
inline Long longSum(Long a, int b) {
    return a + b;
}
inline Long longDifference(Long a, Long b) {
    return a - b;
}
inline bool longIsNegative(Long a) {
    return a < 0;
}
inline float longToFloat(Long a) {
    return static_cast<float>(a);
}

} // namespace voxtact::shader
#else
#include "long_words.h"
#endif

#endif
