// SPDX-License-Identifier: MIT
// The operations that exactness rests on, one at a time: one text for GLSL and C++, so that a device can be asked
// whether it does each of them as the host does, bit for bit (src/device/detector/arithmetic_check.h).
#ifndef VOXTACT_OPERATIONS_H
#define VOXTACT_OPERATIONS_H

#include "long.h"
#include "precise.h"
#if defined(__cplusplus) || defined(DOUBLES)
#define OPERATIONS_OF_DOUBLES
#include "wide.h"
#endif
#include "wide_integers.h"

#define OPERATION_FLOAT_ADD 0
#define OPERATION_FLOAT_SUBTRACT 1
#define OPERATION_FLOAT_MULTIPLY 2
#define OPERATION_FLOAT_MULTIPLY_ADD 3
#define OPERATION_FLOAT_MULTIPLY_SUBTRACT 4
#define OPERATION_FLOAT_SUM_IN_ORDER 5
#define OPERATION_FLOAT_TWO_SUM 6
#define OPERATION_FLOAT_TWO_PRODUCT 7
#define OPERATION_FLOAT_NEGATE 8
#define OPERATION_FLOAT_FLOOR 9
#define OPERATION_FLOAT_COMPARE 10
#define OPERATION_FLOAT_COMPARE_SPECIAL 11
#define OPERATION_FLOAT_SPECIAL_ADD 12
#define OPERATION_FLOAT_SPECIAL_MULTIPLY 13
#define OPERATION_FLOAT_BITS 14
#define OPERATION_INT_TO_FLOAT 15
#define OPERATION_UINT_TO_FLOAT 16
#define OPERATION_FLOAT_TO_INT 17
#define OPERATION_INT_ADD 18
#define OPERATION_INT_MULTIPLY 19
#define OPERATION_INT_SHIFT 20
#define OPERATION_INT_COMPARE 21
#define OPERATION_INT_MIN_MAX 22
#define OPERATION_UINT_SHIFT 23
#define OPERATION_UINT_DIVIDE 24
#define OPERATION_UINT_COMPARE 25
#define OPERATION_UINT_FIRST_BIT 26
#define OPERATION_LONG_PRODUCT 27
#define OPERATION_LONG_SUM 28
#define OPERATION_LONG_DIFFERENCE 29
#define OPERATION_LONG_SIGN 30
#define OPERATION_LONG_TO_FLOAT 31
// Operations in double precision, for devices that support it: shaders with DOUBLES.
#define OPERATION_WIDE_ADD 32
#define OPERATION_WIDE_SUBTRACT 33
#define OPERATION_WIDE_MULTIPLY 34
#define OPERATION_WIDE_COMPARE 35
#define OPERATION_WIDE_TO_FLOAT 36
#define OPERATION_WIDE_OF_FLOAT 37
#define OPERATION_WIDE_SPECIAL_ADD 38
#define OPERATION_WIDE_SPECIAL_MULTIPLY 39
#define OPERATION_WIDE_SPECIAL_COMPARE 40
/// Number of operations.
#define OPERATION_COUNT 41
/// The last one: operations of lanes together. Its results are those of a work group, OPERATION_GROUP_WORDS each.
#define OPERATION_GROUP 41
#define OPERATION_GROUP_WORDS 3

/// Inputs of an operation, in words, and its results.
#define OPERATION_INPUTS 4
#define OPERATION_RESULTS 2

#ifdef __cplusplus
namespace voxtact::shader {
inline int uintAsInt(uint bits) {
    return static_cast<int>(bits);
}
inline uint intAsUint(int value) {
    return static_cast<uint>(value);
}
inline float floatOf(uint bits) {
    return std::bit_cast<float>(bits);
}
inline uint bitsOf(float value) {
    return std::bit_cast<uint>(value);
}
inline void wordsOf(Wide value, uint& low, uint& high) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    low = static_cast<uint>(bits);
    high = static_cast<uint>(bits >> 32U);
}
using integers::wideLeadingZeros;
#else
#define uintAsInt int
#define intAsUint uint
#define floatOf uintBitsToFloat
#define bitsOf floatBitsToUint
#ifdef OPERATIONS_OF_DOUBLES
void wordsOf(Wide value, out uint low, out uint high) {
    const uvec2 words = unpackDouble2x32(value);
    low = words.x;
    high = words.y;
}
#endif
#endif

/// Push constants of operations.comp.
struct OperationConstants {
    uint inputs;      // how many sets of OPERATION_INPUTS words there are
    uint texels;      // 1: reads the volume instead
    float storedUnit; // as in ItemConstants
};

#include "exact_language.h"

/// A float of any sign and mantissa, neither huge nor tiny: a few operations on such floats give normal numbers.
EXACT float operationModerate(uint word) {
    return floatOf((word & 0x807fffffu) | ((((word >> 23) & 63u) + 96u) << 23));
}

/// Six bits: less, less or equal, equal, greater or equal, greater, and not less.
EXACT uint operationCompare(float a, float b) {
    return (a < b ? 1u : 0u) | (a <= b ? 2u : 0u) | (a == b ? 4u : 0u) | (a >= b ? 8u : 0u) | (a > b ? 16u : 0u) |
           (!(a < b) ? 32u : 0u);
}

/// Operations on floats only; returns false if it is none of them.
EXACT bool operationOnFloats(int operation, float a, float b, float c, OUT(uint) low, OUT(uint) high) {
    PRECISE float value = 0.0f;
    high = 0u;
    low = 0u;
    if (operation == OPERATION_FLOAT_ADD || operation == OPERATION_FLOAT_SPECIAL_ADD) {
        value = a + b;
    } else if (operation == OPERATION_FLOAT_SUBTRACT) {
        value = a - b;
    } else if (operation == OPERATION_FLOAT_MULTIPLY || operation == OPERATION_FLOAT_SPECIAL_MULTIPLY) {
        value = a * b;
    } else if (operation == OPERATION_FLOAT_MULTIPLY_ADD) {
        value = a * b + c;
    } else if (operation == OPERATION_FLOAT_MULTIPLY_SUBTRACT) {
        value = c - a * b;
    } else if (operation == OPERATION_FLOAT_SUM_IN_ORDER) {
        value = a + b + c;
    } else if (operation == OPERATION_FLOAT_NEGATE) {
        value = -a;
    } else if (operation == OPERATION_FLOAT_FLOOR) {
        value = floor(a);
    } else if (operation == OPERATION_FLOAT_TWO_SUM) {
        const PreciseTwo sum = preciseSum(a, b);
        low = bitsOf(sum.high);
        high = bitsOf(sum.low);
        return true;
    } else if (operation == OPERATION_FLOAT_TWO_PRODUCT) {
        const PreciseTwo product = preciseProduct(a, b);
        low = bitsOf(product.high);
        high = bitsOf(product.low);
        return true;
    } else if (operation == OPERATION_FLOAT_COMPARE || operation == OPERATION_FLOAT_COMPARE_SPECIAL) {
        low = operationCompare(a, b);
        high = operationCompare(a, a);
        return true;
    } else {
        return false;
    }
    low = bitsOf(value);
    return true;
}

#ifdef OPERATIONS_OF_DOUBLES
/// Like above, in double precision.
EXACT Wide operationWide(uint high, uint low) {
    return wideBits((high & 0x800fffffu) | ((((high >> 20) & 63u) + 992u) << 20), low);
}

/// Like above, of any kind but denormals, which need not match: zero, infinite, NaN, huge, but usually others.
EXACT Wide operationAnyWide(uint high, uint low) {
    const uint kind = (high >> 20) & 7u;
    const uint sign = high & 0x80000000u;
    const uint mantissa = high & 0x000fffffu;
    if (kind == 0u) {
        return wideBits(sign, 0u);
    }
    if (kind == 1u) {
        return wideBits(sign | 0x7ff00000u, 0u);
    }
    if (kind == 2u) {
        return wideBits(sign | 0x7ff80000u | mantissa, low);
    }
    return kind == 3u ? wideBits(sign | 0x7fe00000u | mantissa, low) : operationWide(high, low);
}

/// Operations of double precision, on a and b, and on c and d; false: it is none of them.
EXACT bool operationOnWides(int operation, uint a, uint b, uint c, uint d, OUT(uint) low, OUT(uint) high) {
    low = 0u;
    high = 0u;
    const bool special = operation >= OPERATION_WIDE_SPECIAL_ADD && operation <= OPERATION_WIDE_SPECIAL_COMPARE;
    const Wide left = special ? operationAnyWide(a, b) : operationWide(a, b);
    const Wide right = special ? operationAnyWide(c, d) : operationWide(c, d);
    Wide value = left;
    if (operation == OPERATION_WIDE_ADD || operation == OPERATION_WIDE_SPECIAL_ADD) {
        value = wideAdd(left, right);
    } else if (operation == OPERATION_WIDE_SUBTRACT) {
        value = wideSubtract(left, right);
    } else if (operation == OPERATION_WIDE_MULTIPLY || operation == OPERATION_WIDE_SPECIAL_MULTIPLY) {
        value = wideMultiply(left, right);
    } else if (operation == OPERATION_WIDE_COMPARE || operation == OPERATION_WIDE_SPECIAL_COMPARE) {
        low = (wideLess(left, right) ? 1u : 0u) | (wideAtLeast(left, right) ? 2u : 0u);
        high = wideLess(wideAbs(left), wideAbs(right)) ? 1u : 0u;
        return true;
    } else if (operation == OPERATION_WIDE_TO_FLOAT) {
        low = wideToFloatBits(left);
        return true;
    } else if (operation == OPERATION_WIDE_OF_FLOAT) {
        value = wideOfFloatBits(bitsOf(operationModerate(a)));
    } else {
        return false;
    }
    wordsOf(value, low, high);
    if (special && !wideAtLeast(value, value)) { // one NaN is as good as another
        low = 0u;
        high = 0x7ff80000u;
    }
    return true;
}
#endif

/// Conversions between the kinds of numbers, and operations on 32-bit integers; false: it is none of them.
EXACT bool operationOnWords(int operation, uint a, uint b, OUT(uint) low, OUT(uint) high) {
    high = 0u;
    low = 0u;
    if (operation == OPERATION_FLOAT_BITS) {
        low = bitsOf(floatOf(a));
    } else if (operation == OPERATION_INT_TO_FLOAT) {
        low = bitsOf(float(uintAsInt(a)));
    } else if (operation == OPERATION_UINT_TO_FLOAT) {
        // Only integers that floats represent: the rounding of others need not match.
        low = bitsOf(float(a & 0xffffffu));
        high = bitsOf(float(a >> 8));
    } else if (operation == OPERATION_FLOAT_TO_INT) {
        low = intAsUint(int(floatOf((a & 0x807fffffu) | ((((a >> 23) & 15u) * 2u + 126u) << 23))));
    } else if (operation == OPERATION_INT_ADD) {
        low = a + b;
        high = a - b;
    } else if (operation == OPERATION_INT_MULTIPLY) {
        low = a * b;
    } else if (operation == OPERATION_INT_SHIFT) {
        low = intAsUint(uintAsInt(a) >> uintAsInt(b & 31u));
    } else if (operation == OPERATION_INT_COMPARE) {
        low = (uintAsInt(a) < uintAsInt(b) ? 1u : 0u) | (uintAsInt(a) <= uintAsInt(b) ? 2u : 0u) |
              (uintAsInt(a) == uintAsInt(b) ? 4u : 0u);
    } else if (operation == OPERATION_INT_MIN_MAX) {
        low = uintAsInt(a) < uintAsInt(b) ? a : b;
        high = uintAsInt(a) < uintAsInt(b) ? b : a;
    } else if (operation == OPERATION_UINT_SHIFT) {
        low = a >> (b & 31u);
        high = a << (b & 31u);
    } else if (operation == OPERATION_UINT_DIVIDE) {
        low = a / (b | 1u);
        high = a % (b | 1u);
    } else if (operation == OPERATION_UINT_COMPARE) {
        low = (a < b ? 1u : 0u) | (a <= b ? 2u : 0u) | (a == b ? 4u : 0u);
    } else if (operation == OPERATION_UINT_FIRST_BIT) {
        low = wideLeadingZeros(a);
        high = wideLeadingZeros(a >> (b & 31u));
    } else {
        return false;
    }
    return true;
}

/// Operations with 64-bit integers: of a and b, and of c and d, the low words first, as much of them as each takes.
EXACT void operationOnLongs(int operation, uint a, uint b, uint c, uint d, OUT(uint) low, OUT(uint) high) {
    low = 0u;
    high = 0u;
    if (operation == OPERATION_LONG_TO_FLOAT) {
        low = bitsOf(longToFloat(longOf(uintAsInt(b) >> 15, a)));
        high = bitsOf(longToFloat(longOf(uintAsInt(d) >> 31, c)));
        return;
    }
    if (operation == OPERATION_LONG_SIGN) {
        low = longIsNegative(longOf(uintAsInt(b), a)) ? 1u : 0u;
        high = longIsNegative(longOf(uintAsInt(d), c)) ? 1u : 0u;
        return;
    }
    Long value = longProduct(uintAsInt(a), uintAsInt(b));
    if (operation == OPERATION_LONG_SUM) {
        value = longSum(longOf(uintAsInt(b) >> 1, a), uintAsInt(c));
    } else if (operation == OPERATION_LONG_DIFFERENCE) {
        value = longDifference(longOf(uintAsInt(b) >> 1, a), longOf(uintAsInt(d) >> 1, c));
    }
    low = longLow(value);
    high = longHigh(value);
}

/// One operation on four words; two words of results.
EXACT void operate(int operation, uint a, uint b, uint c, uint d, OUT(uint) low, OUT(uint) high) {
    // Operations on zeros, infinities, NaN, huge and tiny numbers take the words unchanged.
    const bool special = operation == OPERATION_FLOAT_COMPARE_SPECIAL || operation == OPERATION_FLOAT_SPECIAL_ADD ||
                         operation == OPERATION_FLOAT_SPECIAL_MULTIPLY;
    const float left = special ? floatOf(a) : operationModerate(a);
    const float right = special ? floatOf(b) : operationModerate(b);
    bool done = operationOnFloats(operation, left, right, operationModerate(c), low, high) ||
                operationOnWords(operation, a, b, low, high);
#ifdef OPERATIONS_OF_DOUBLES
    done = done || operationOnWides(operation, a, b, c, d, low, high);
#endif
    if (!done) {
        operationOnLongs(operation, a, b, c, d, low, high);
    }
}

#include "exact_language.h"

#ifdef __cplusplus
static_assert(sizeof(OperationConstants) == 12);
} // namespace voxtact::shader
#else
#undef uintAsInt
#undef intAsUint
#undef floatOf
#undef bitsOf
#endif

#endif
