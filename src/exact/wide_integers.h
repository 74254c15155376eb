// SPDX-License-Identifier: MIT
// Quotients of double precision, and what is converted to it and from it, by 32-bit integers: of these Vulkan does not
// ask a device that has doubles to round like the host (wide_doubles.glsl). IEEE 754 binary64, rounded to the nearest,
// ties to even, denormals and infinities as they should be; a NaN is the positive quiet one. One text for GLSL and C++,
// where tests compare it with `double`.
//
// Nothing branches, but for the rounds of a division: both sides of a choice are computed. Programs have these
// functions dozens of times, and without branches lavapipe makes them in half the time.
#ifndef VOXTACT_WIDE_INTEGERS_H
#define VOXTACT_WIDE_INTEGERS_H

#include "shared.h"

#include "exact_language.h"

#ifdef __cplusplus
#include <bit>

namespace voxtact::shader::integers {
inline uint wideLeadingZeros(uint word) {
    return static_cast<uint>(std::countl_zero(word));
}
inline uint wideChoice(bool first, uint a, uint b) {
    return first ? a : b;
}
#else
#define wideLeadingZeros(word) uint(31 - findMSB(word))
#define wideChoice(first, a, b) mix(b, a, first) // a ternary operator would branch
#endif

/// The bits of a number.
struct Wide {
    uint low;
    uint high;
};

/// An unsigned number of 64 bits.
struct WideWord {
    uint high;
    uint low;
};

/// A number that is neither infinite nor NaN: significand / 2^62 * 2^(exponent - 1023).
struct WideParts {
    uint sign;            // in the first bit
    int exponent;         // as it is stored; less than 1 for denormals
    WideWord significand; // its first bit is bit 62; 0 for zero
};

#ifdef __cplusplus
inline Wide wideBits(uint high, uint low) {
    return {low, high};
}
inline WideWord wideWord(uint high, uint low) {
    return {high, low};
}
#else
#define wideBits(high, low) Wide(low, high)
#define wideWord WideWord
#endif

EXACT WideWord wordChoice(bool first, WideWord a, WideWord b) {
    return wideWord(wideChoice(first, a.high, b.high), wideChoice(first, a.low, b.low));
}

EXACT Wide wideEither(bool first, Wide a, Wide b) {
    return wideBits(wideChoice(first, a.high, b.high), wideChoice(first, a.low, b.low));
}

EXACT WideWord wordSum(WideWord a, WideWord b) {
    const uint low = a.low + b.low;
    return wideWord(a.high + b.high + uint(low < a.low), low);
}

EXACT WideWord wordDifference(WideWord a, WideWord b) {
    return wideWord(a.high - b.high - uint(a.low < b.low), a.low - b.low);
}

EXACT bool wordLess(WideWord a, WideWord b) {
    const bool less = a.high < b.high;
    const bool same = a.high == b.high;
    const bool lower = a.low < b.low;
    const bool sameAndLower = same && lower;
    return less || sameAndLower;
}

EXACT bool wordIsZero(WideWord a) {
    return (a.high | a.low) == 0u;
}

/// By 0 to 63 bits.
EXACT WideWord wordLeft(WideWord a, uint bits) {
    const uint by = bits & 31u;
    const uint low = a.low << by;
    const uint high = (a.high << by) | ((a.low >> 1) >> (31u - by));
    const bool whole = bits >= 32u;
    return wideWord(wideChoice(whole, low, high), wideChoice(whole, 0u, low));
}

/// By any number of bits; what is lost sets the last bit.
EXACT WideWord wordRight(WideWord a, uint bits) {
    const uint by = bits & 31u;
    const uint high = a.high >> by;
    const uint low = (a.low >> by) | ((a.high << 1) << (31u - by));
    const uint beyond = (a.low << 1) << (31u - by);
    const bool whole = bits >= 32u;
    const bool all = bits >= 64u;
    const uint kept = wideChoice(all, 0u, wideChoice(whole, high, low));
    const uint lost = wideChoice(all, a.high | a.low, beyond | wideChoice(whole, low, 0u));
    WideWord result = wideWord(wideChoice(whole, 0u, high), kept);
    result.low |= uint(lost != 0u);
    return result;
}

/// Returns the leading zeros of a number other than zero.
EXACT uint wordLeadingZeros(WideWord a) {
    const uint ofLow = 32u + wideLeadingZeros(a.low);
    const uint ofHigh = wideLeadingZeros(a.high);
    return wideChoice(a.high == 0u, ofLow, ofHigh);
}

EXACT uint wideSign(Wide a) {
    return a.high & 0x80000000u;
}

EXACT uint wideExponent(Wide a) {
    return (a.high >> 20) & 0x7ffu;
}

EXACT WideWord wideSize(Wide a) {
    return wideWord(a.high & 0x7fffffffu, a.low);
}

EXACT bool wideIsZero(Wide a) {
    return wordIsZero(wideSize(a));
}

EXACT bool wideIsInfinite(Wide a) {
    return (((a.high & 0x7fffffffu) ^ 0x7ff00000u) | a.low) == 0u;
}

EXACT bool wideIsNan(Wide a) {
    return ((a.high & 0x7fffffffu) | uint(a.low != 0u)) > 0x7ff00000u;
}

EXACT Wide wideNan() {
    return wideBits(0x7ff80000u, 0u);
}

EXACT Wide wideInfinity(uint sign) {
    return wideBits(sign | 0x7ff00000u, 0u);
}

/// The significand as it is stored, its first bit, if it has one, in bit 62.
EXACT WideWord wideStored(Wide a) {
    const uint first = wideChoice(wideExponent(a) == 0u, 0u, 0x40000000u);
    return wideWord(first | ((a.high & 0xfffffu) << 10) | (a.low >> 22), a.low << 10);
}

/// The exponent of what wideStored() has.
EXACT int wideScale(Wide a) {
    const uint stored = wideExponent(a);
    return int(stored + uint(stored == 0u));
}

/// Returns the parts of a finite number.
EXACT WideParts wideParts(Wide a) {
    const WideWord stored = wideStored(a);
    const uint shift = (wordLeadingZeros(stored) - 1u) & 63u;
    WideParts parts;
    parts.sign = wideSign(a);
    parts.exponent = wideScale(a) - int(shift);
    parts.significand = wordLeft(stored, shift);
    return parts;
}

/// The nearest number to one that is not zero.
EXACT Wide wideOfParts(WideParts parts) {
    const bool normal = parts.exponent > 0;
    const WideWord all = wordRight(parts.significand, wideChoice(normal, 0u, uint(1 - parts.exponent)));
    const uint beyond = all.low & 0x3ffu;
    const WideWord rounded = wordSum(all, wideWord(0u, 0x200u));
    WideWord bits = wideWord(rounded.high >> 10, (rounded.high << 22) | (rounded.low >> 10));
    bits.low &= ~uint(beyond == 0x200u);
    // The first bit of a normal significand adds one to the exponent, and so does what was carried.
    const uint exponent = wideChoice(normal, uint(parts.exponent - 1) << 20, 0u);
    const Wide found = wideBits(parts.sign | (exponent + bits.high), bits.low);
    return wideEither(parts.exponent >= 0x7ff, wideInfinity(parts.sign), found);
}

/// Returns a quotient: `found` unless a bit says zero, infinity or NaN. Zero and infinity together are NaN.
EXACT Wide wideSpecial(Wide found, uint zero, uint infinite, uint nan) {
    const Wide finite = wideEither(zero != 0u, wideBits(wideSign(found), 0u), found);
    const Wide number = wideEither(infinite != 0u, wideInfinity(wideSign(found)), finite);
    return wideEither((nan | (zero & infinite)) != 0u, wideNan(), number);
}

/// Returns the quotient of two finite numbers other than zero.
EXACT Wide wideQuotientOfParts(WideParts a, WideParts b) {
    // Computes 54 bits of the quotient, one per round; the first bit is one, and the remainder is less than twice the
    // divisor.
    const WideWord divisor = wordRight(b.significand, 10u);
    const WideWord dividend = wordRight(a.significand, 10u);
    const uint shift = uint(wordLess(dividend, divisor));
    WideWord rest = wordLeft(dividend, shift);
    WideWord quotient = wideWord(0u, 0u);
    ROLLED for (int round = 0; round < 54; ++round) {
        const bool fits = !wordLess(rest, divisor);
        quotient = wordLeft(quotient, 1u);
        quotient.low |= uint(fits);
        rest = wordLeft(wordChoice(fits, wordDifference(rest, divisor), rest), 1u);
    }
    WideParts result;
    result.sign = a.sign ^ b.sign;
    result.exponent = a.exponent - b.exponent + 1023 - int(shift);
    result.significand = wordLeft(quotient, 9u);
    result.significand.low |= uint(!wordIsZero(rest));
    return wideOfParts(result);
}

EXACT Wide wideDivide(Wide a, Wide b) {
    const uint zero = uint(wideIsZero(a)) | uint(wideIsInfinite(b));
    const uint infinite = uint(wideIsInfinite(a)) | uint(wideIsZero(b));
    const uint nan = uint(wideIsNan(a)) | uint(wideIsNan(b));
    return wideSpecial(wideQuotientOfParts(wideParts(a), wideParts(b)), zero, infinite, nan);
}

/// The bits of the nearest float.
EXACT uint wideToFloatBits(Wide a) {
    const uint sign = wideSign(a);
    const WideParts parts = wideParts(a);
    const int exponent = parts.exponent - 896;
    const bool normal = exponent > 0;
    const uint all = wordRight(parts.significand, 32u + wideChoice(normal, 0u, uint(1 - exponent))).low;
    uint bits = (all + 0x40u) >> 7;
    bits &= ~uint((all & 0x7fu) == 0x40u);
    bits += wideChoice(normal, uint(exponent - 1) << 23, 0u);
    bits = wideChoice(exponent >= 0xff, 0x7f800000u, bits);
    bits = wideChoice(wideIsZero(a), 0u, bits);
    return wideChoice(wideIsNan(a), 0x7fc00000u, sign | bits);
}

/// The number that the bits of a float are, exactly.
EXACT Wide wideOfFloatBits(uint bits) {
    const uint sign = bits & 0x80000000u;
    const uint size = bits & 0x7fffffffu;
    const uint fraction = bits & 0x7fffffu;
    // Denormal floats are normal numbers here.
    const uint shift = (wideLeadingZeros(fraction) - 8u) & 31u;
    const bool denormal = size < 0x800000u;
    const uint significand = wideChoice(denormal, fraction << shift, fraction);
    const uint exponent = wideChoice(denormal, 0u - shift, size >> 23) + 896u;
    const Wide finite = wideBits(sign | ((exponent << 20) + (significand >> 3)), significand << 29);
    const Wide special = wideEither(size > 0x7f800000u, wideNan(), wideInfinity(sign));
    const Wide found = wideEither(size >= 0x7f800000u, special, finite);
    return wideEither(size == 0u, wideBits(sign, 0u), found);
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader::integers
#endif

#endif
