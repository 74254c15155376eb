// SPDX-License-Identifier: MIT
// Double precision by 32-bit integers, for shaders: hardly any phone has it, and those GPUs that do need not round like
// the host. IEEE 754 binary64, rounded to the nearest, ties to even, denormals and infinities as they should be; a NaN
// is the positive quiet one. One text for GLSL and C++, where tests compare it with `double`.
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
inline void umulExtended(uint a, uint b, uint& high, uint& low) {
    const std::uint64_t product = std::uint64_t{a} * b;
    high = static_cast<uint>(product >> 32U);
    low = static_cast<uint>(product);
}
#else
#define wideLeadingZeros(word) uint(31 - findMSB(word))
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

/// A number that is neither zero, infinite nor NaN: significand / 2^62 * 2^(exponent - 1023).
struct WideParts {
    uint sign;            // in the first bit
    int exponent;         // as it is stored; less than 1 for denormals
    WideWord significand; // its first bit is bit 62
};

EXACT Wide wideBits(uint high, uint low) {
    Wide wide;
    wide.low = low;
    wide.high = high;
    return wide;
}

EXACT WideWord wideWord(uint high, uint low) {
    WideWord word;
    word.high = high;
    word.low = low;
    return word;
}

EXACT WideWord wordSum(WideWord a, WideWord b) {
    const uint low = a.low + b.low;
    return wideWord(a.high + b.high + (low < a.low ? 1u : 0u), low);
}

EXACT WideWord wordDifference(WideWord a, WideWord b) {
    return wideWord(a.high - b.high - (a.low < b.low ? 1u : 0u), a.low - b.low);
}

EXACT bool wordLess(WideWord a, WideWord b) {
    return a.high < b.high || (a.high == b.high && a.low < b.low);
}

/// By 0 to 63 bits.
EXACT WideWord wordLeft(WideWord a, uint bits) {
    if (bits == 0u) {
        return a;
    }
    return bits < 32u ? wideWord((a.high << bits) | (a.low >> (32u - bits)), a.low << bits)
                      : wideWord(a.low << (bits - 32u), 0u);
}

/// By any number of bits; what is lost sets the last bit.
EXACT WideWord wordRight(WideWord a, uint bits) {
    if (bits == 0u) {
        return a;
    }
    if (bits >= 64u) {
        return wideWord(0u, (a.high | a.low) != 0u ? 1u : 0u);
    }
    uint lost;
    WideWord result;
    if (bits < 32u) {
        lost = a.low << (32u - bits);
        result = wideWord(a.high >> bits, (a.high << (32u - bits)) | (a.low >> bits));
    } else {
        lost = bits == 32u ? a.low : (a.low | (a.high << (64u - bits)));
        result = wideWord(0u, a.high >> (bits - 32u));
    }
    result.low |= lost != 0u ? 1u : 0u;
    return result;
}

/// Of a number that is not zero.
EXACT uint wordLeadingZeros(WideWord a) {
    return a.high == 0u ? 32u + wideLeadingZeros(a.low) : wideLeadingZeros(a.high);
}

EXACT WideWord wordProduct(uint a, uint b) {
    uint high;
    uint low;
    umulExtended(a, b, high, low);
    return wideWord(high, low);
}

EXACT uint wideSign(Wide a) {
    return a.high & 0x80000000u;
}

EXACT uint wideExponent(Wide a) {
    return (a.high >> 20) & 0x7ffu;
}

EXACT bool wideIsZero(Wide a) {
    return ((a.high & 0x7fffffffu) | a.low) == 0u;
}

EXACT bool wideIsInfinite(Wide a) {
    return (a.high & 0x7fffffffu) == 0x7ff00000u && a.low == 0u;
}

EXACT bool wideIsNan(Wide a) {
    return wideExponent(a) == 0x7ffu && ((a.high & 0xfffffu) | a.low) != 0u;
}

EXACT Wide wideNan() {
    return wideBits(0x7ff80000u, 0u);
}

EXACT Wide wideInfinity(uint sign) {
    return wideBits(sign | 0x7ff00000u, 0u);
}

EXACT WideParts wideParts(Wide a) {
    const uint stored = wideExponent(a);
    const WideWord fraction = wideWord((a.high & 0xfffffu) | (stored == 0u ? 0u : 0x100000u), a.low);
    const uint shift = wordLeadingZeros(fraction) - 1u;
    WideParts parts;
    parts.sign = wideSign(a);
    parts.exponent = (stored == 0u ? 1 : int(stored)) + 10 - int(shift);
    parts.significand = wordLeft(fraction, shift);
    return parts;
}

EXACT Wide wideOfParts(WideParts parts) {
    if (parts.exponent >= 0x7ff) {
        return wideInfinity(parts.sign);
    }
    const bool normal = parts.exponent > 0;
    const WideWord all = normal ? parts.significand : wordRight(parts.significand, uint(1 - parts.exponent));
    const uint beyond = all.low & 0x3ffu;
    const WideWord rounded = wordSum(all, wideWord(0u, 0x200u));
    WideWord bits = wideWord(rounded.high >> 10, (rounded.high << 22) | (rounded.low >> 10));
    if (beyond == 0x200u) {
        bits.low &= ~1u;
    }
    // The first bit of a normal significand adds one to the exponent, and so does what was carried.
    return wideBits(parts.sign | ((normal ? uint(parts.exponent - 1) << 20 : 0u) + bits.high), bits.low);
}

EXACT Wide wideNegated(Wide a) {
    return wideBits(a.high ^ 0x80000000u, a.low);
}

EXACT Wide wideAbs(Wide a) {
    return wideBits(a.high & 0x7fffffffu, a.low);
}

/// Of two numbers that are neither zero, infinite nor NaN.
EXACT Wide wideSumOfParts(WideParts a, WideParts b) {
    const bool swap = a.exponent < b.exponent || (a.exponent == b.exponent && wordLess(a.significand, b.significand));
    WideParts large = a;
    WideParts small = b;
    if (swap) {
        large = b;
        small = a;
    }
    const WideWord other = wordRight(small.significand, uint(large.exponent - small.exponent));
    if (large.sign == small.sign) {
        large.significand = wordSum(large.significand, other);
        if (large.significand.high >= 0x80000000u) {
            large.significand = wordRight(large.significand, 1u);
            large.exponent += 1;
        }
        return wideOfParts(large);
    }
    large.significand = wordDifference(large.significand, other);
    if ((large.significand.high | large.significand.low) == 0u) {
        return wideBits(0u, 0u);
    }
    const uint shift = wordLeadingZeros(large.significand) - 1u;
    large.significand = wordLeft(large.significand, shift);
    large.exponent -= int(shift);
    return wideOfParts(large);
}

EXACT Wide wideAdd(Wide a, Wide b) {
    if (wideIsNan(a) || wideIsNan(b)) {
        return wideNan();
    }
    if (wideIsInfinite(a)) {
        return wideIsInfinite(b) && wideSign(a) != wideSign(b) ? wideNan() : a;
    }
    if (wideIsInfinite(b)) {
        return b;
    }
    if (wideIsZero(a) && wideIsZero(b)) {
        return wideBits(a.high & b.high, 0u);
    }
    if (wideIsZero(a)) {
        return b;
    }
    return wideIsZero(b) ? a : wideSumOfParts(wideParts(a), wideParts(b));
}

EXACT Wide wideSubtract(Wide a, Wide b) {
    return wideAdd(a, wideNegated(b));
}

EXACT Wide wideMultiply(Wide a, Wide b) {
    const uint sign = wideSign(a) ^ wideSign(b);
    if (wideIsNan(a) || wideIsNan(b)) {
        return wideNan();
    }
    if (wideIsInfinite(a) || wideIsInfinite(b)) {
        return wideIsZero(a) || wideIsZero(b) ? wideNan() : wideInfinity(sign);
    }
    if (wideIsZero(a) || wideIsZero(b)) {
        return wideBits(sign, 0u);
    }
    const WideParts first = wideParts(a);
    const WideParts second = wideParts(b);
    const WideWord x = first.significand;
    const WideWord y = wordLeft(second.significand, 1u);
    // The high word of x * y, by words of 32 bits; none of the sums overflows.
    const WideWord lows = wordProduct(x.low, y.low);
    const WideWord mixed = wordSum(wordProduct(x.low, y.high), wideWord(0u, lows.high));
    const WideWord middle = wordSum(wordProduct(x.high, y.low), wideWord(0u, mixed.low));
    WideParts result;
    result.sign = sign;
    result.exponent = first.exponent + second.exponent - 1022;
    result.significand =
        wordSum(wordSum(wordProduct(x.high, y.high), wideWord(0u, mixed.high)), wideWord(0u, middle.high));
    result.significand.low |= (middle.low | lows.low) != 0u ? 1u : 0u;
    if (result.significand.high < 0x40000000u) {
        result.significand = wordLeft(result.significand, 1u);
        result.exponent -= 1;
    }
    return wideOfParts(result);
}

/// Of two numbers that are neither zero, infinite nor NaN.
EXACT Wide wideQuotientOfParts(WideParts a, WideParts b) {
    // 54 bits of the quotient, the first of them one, a bit a round; the remainder is less than twice the divisor.
    const WideWord divisor = wordRight(b.significand, 10u);
    WideWord rest = wordRight(a.significand, 10u);
    WideParts result;
    result.sign = a.sign ^ b.sign;
    result.exponent = a.exponent - b.exponent + 1023;
    if (wordLess(rest, divisor)) {
        rest = wordLeft(rest, 1u);
        result.exponent -= 1;
    }
    WideWord quotient = wideWord(0u, 0u);
    ROLLED for (int round = 0; round < 54; ++round) {
        quotient = wordLeft(quotient, 1u);
        if (!wordLess(rest, divisor)) {
            rest = wordDifference(rest, divisor);
            quotient.low |= 1u;
        }
        rest = wordLeft(rest, 1u);
    }
    result.significand = wordLeft(quotient, 9u);
    result.significand.low |= (rest.high | rest.low) != 0u ? 1u : 0u;
    return wideOfParts(result);
}

EXACT Wide wideDivide(Wide a, Wide b) {
    const uint sign = wideSign(a) ^ wideSign(b);
    if (wideIsNan(a) || wideIsNan(b) || (wideIsInfinite(a) && wideIsInfinite(b)) || (wideIsZero(a) && wideIsZero(b))) {
        return wideNan();
    }
    if (wideIsInfinite(a) || wideIsZero(b)) {
        return wideInfinity(sign);
    }
    if (wideIsInfinite(b) || wideIsZero(a)) {
        return wideBits(sign, 0u);
    }
    return wideQuotientOfParts(wideParts(a), wideParts(b));
}

EXACT bool wideLess(Wide a, Wide b) {
    if (wideIsNan(a) || wideIsNan(b) || (wideIsZero(a) && wideIsZero(b))) {
        return false;
    }
    if (wideSign(a) != wideSign(b)) {
        return wideSign(a) != 0u;
    }
    const bool less = wordLess(wideWord(a.high, a.low), wideWord(b.high, b.low));
    const bool more = wordLess(wideWord(b.high, b.low), wideWord(a.high, a.low));
    return wideSign(a) != 0u ? more : less;
}

/// Whether a >= b.
EXACT bool wideAtLeast(Wide a, Wide b) {
    return !(wideIsNan(a) || wideIsNan(b) || wideLess(a, b));
}

/// The bits of the nearest float.
EXACT uint wideToFloatBits(Wide a) {
    const uint sign = wideSign(a);
    if (wideIsNan(a)) {
        return 0x7fc00000u;
    }
    if (wideIsInfinite(a)) {
        return sign | 0x7f800000u;
    }
    if (wideIsZero(a)) {
        return sign;
    }
    const WideParts parts = wideParts(a);
    const int exponent = parts.exponent - 896;
    if (exponent >= 0xff) {
        return sign | 0x7f800000u;
    }
    const bool normal = exponent > 0;
    const uint all = wordRight(parts.significand, normal ? 32u : uint(33 - exponent)).low;
    uint bits = (all + 0x40u) >> 7;
    if ((all & 0x7fu) == 0x40u) {
        bits &= ~1u;
    }
    return sign | ((normal ? uint(exponent - 1) << 23 : 0u) + bits);
}

/// The number that the bits of a float are, exactly.
EXACT Wide wideOfFloatBits(uint bits) {
    const uint sign = bits & 0x80000000u;
    const uint stored = (bits >> 23) & 0xffu;
    const uint fraction = bits & 0x7fffffu;
    if (stored == 0xffu) {
        return fraction != 0u ? wideNan() : wideInfinity(sign);
    }
    if (stored == 0u && fraction == 0u) {
        return wideBits(sign, 0u);
    }
    const WideWord significand = wideWord(0u, fraction | (stored == 0u ? 0u : 0x800000u));
    const uint shift = wordLeadingZeros(significand) - 1u;
    WideParts parts;
    parts.sign = sign;
    parts.exponent = (stored == 0u ? 1 : int(stored)) + 896 + 39 - int(shift);
    parts.significand = wordLeft(significand, shift);
    return wideOfParts(parts);
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader::integers
#endif

#endif
