// SPDX-License-Identifier: MIT
// Numbers of double precision, the same bits in C++, where they are `double`, and in GLSL, where shaders with DOUBLES
// have the device's.
#ifndef VOXTACT_WIDE_H
#define VOXTACT_WIDE_H

#ifdef __cplusplus
#include "shared.h"

#include <bit>
#include <cmath>

namespace voxtact::shader {

using Wide = double;

inline Wide wideBits(uint high, uint low) {
    return std::bit_cast<double>(std::uint64_t{high} << 32U | low);
}
inline Wide wideAdd(Wide a, Wide b) {
    return a + b;
}
inline Wide wideSubtract(Wide a, Wide b) {
    return a - b;
}
inline Wide wideMultiply(Wide a, Wide b) {
    return a * b;
}
inline Wide wideDivide(Wide a, Wide b) {
    return a / b;
}
inline Wide wideAbs(Wide a) {
    return std::abs(a);
}
inline bool wideLess(Wide a, Wide b) {
    return a < b;
}
inline bool wideAtLeast(Wide a, Wide b) {
    return a >= b;
}
inline uint wideToFloatBits(Wide a) {
    return std::bit_cast<uint>(static_cast<float>(a));
}
inline Wide wideOfFloatBits(uint bits) {
    return static_cast<double>(std::bit_cast<float>(bits));
}
inline float wideFloatOf(uint bits) {
    return std::bit_cast<float>(bits);
}

} // namespace voxtact::shader
#else
#include "count/wide_doubles.glsl"
#define wideFloatOf uintBitsToFloat
#endif

#endif
