// SPDX-License-Identifier: MIT
// The operations that exactness rests on, one at a time: one text for GLSL and C++, so that a device can be asked
// whether it does each of them as the host does, bit for bit (src/detect/arithmetic_check.h).
#ifndef VOXTACT_OPERATIONS_H
#define VOXTACT_OPERATIONS_H

#include "precise.h"

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
#define OPERATION_INT64_TO_FLOAT 17
#define OPERATION_FLOAT_TO_INT 18
#define OPERATION_INT_ADD 19
#define OPERATION_INT_MULTIPLY 20
#define OPERATION_INT_SHIFT 21
#define OPERATION_INT_COMPARE 22
#define OPERATION_INT_MIN_MAX 23
#define OPERATION_UINT_SHIFT 24
#define OPERATION_UINT_DIVIDE 25
#define OPERATION_UINT_COMPARE 26
#define OPERATION_INT64_WIDEN 27
#define OPERATION_INT64_ADD 28
#define OPERATION_INT64_SUBTRACT 29
#define OPERATION_INT64_MULTIPLY 30
#define OPERATION_INT64_SHIFT 31
#define OPERATION_INT64_COMPARE 32
/// How many there are.
#define OPERATION_COUNT 33
/// The one behind them: what lanes do together. Its results are those of a work group, OPERATION_GROUP_WORDS each.
#define OPERATION_GROUP 33
#define OPERATION_GROUP_WORDS 6

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
#else
#define uintAsInt int
#define intAsUint uint
#define floatOf uintBitsToFloat
#define bitsOf floatBitsToUint
#endif

/// Push constants of operations.comp.
struct OperationConstants {
    uint inputs;      // how many sets of OPERATION_INPUTS words there are
    uint texels;      // 1: reads the volume instead
    float storedUnit; // as in ItemConstants
};

#include "exact_language.h"

/// A float of any sign and mantissa that is neither huge nor tiny: what few operations make of such is normal.
EXACT float operationModerate(uint word) {
    return floatOf((word & 0x807fffffu) | ((((word >> 23) & 63u) + 96u) << 23));
}

/// Six bits: less, less or equal, equal, greater or equal, greater, and not less.
EXACT uint operationCompare(float a, float b) {
    return (a < b ? 1u : 0u) | (a <= b ? 2u : 0u) | (a == b ? 4u : 0u) | (a >= b ? 8u : 0u) | (a > b ? 16u : 0u) |
           (!(a < b) ? 32u : 0u);
}

/// Operations on floats alone; false: it is none of them.
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

/// Conversions between the kinds of numbers, and operations on 32-bit integers; false: it is none of them.
EXACT bool operationOnWords(int operation, uint a, uint b, OUT(uint) low, OUT(uint) high) {
    high = 0u;
    low = 0u;
    if (operation == OPERATION_FLOAT_BITS) {
        low = bitsOf(floatOf(a));
    } else if (operation == OPERATION_INT_TO_FLOAT) {
        low = bitsOf(float(uintAsInt(a)));
    } else if (operation == OPERATION_UINT_TO_FLOAT) {
        low = bitsOf(float(a));
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
    } else {
        return false;
    }
    return true;
}

/// Operations on 64-bit integers: of a and b, and of c and d, the low words first. Nothing overflows, which C++ leaves
/// open.
EXACT void operationOnLongs(int operation, uint a, uint b, uint c, uint d, OUT(uint) low, OUT(uint) high) {
    INT64 left = (INT64(uintAsInt(b)) << 32) | INT64(a);
    INT64 right = (INT64(uintAsInt(d)) << 32) | INT64(c);
    INT64 value = INT64(0);
    if (operation == OPERATION_INT64_TO_FLOAT) {
        low = bitsOf(float(left));
        high = bitsOf(float(left >> (d & 63u)));
        return;
    }
    if (operation == OPERATION_INT64_COMPARE) {
        low = (left < right ? 1u : 0u) | (left <= right ? 2u : 0u) | (left == right ? 4u : 0u);
        high = left > INT64(0) ? 1u : 0u;
        return;
    }
    if (operation == OPERATION_INT64_WIDEN) {
        value = INT64(uintAsInt(a));
    } else if (operation == OPERATION_INT64_ADD) {
        value = (left >> 1) + (right >> 1);
    } else if (operation == OPERATION_INT64_SUBTRACT) {
        value = (left >> 1) - (right >> 1);
    } else if (operation == OPERATION_INT64_MULTIPLY) {
        value = INT64(uintAsInt(a)) * INT64(uintAsInt(c));
    } else if (operation == OPERATION_INT64_SHIFT) {
        value = left >> (c & 63u);
    }
    low = uint(value & INT64(0xffffffffu));
    high = uint((value >> 32) & INT64(0xffffffffu));
}

/// One operation on four words; two words of results.
EXACT void operate(int operation, uint a, uint b, uint c, uint d, OUT(uint) low, OUT(uint) high) {
    // Those on zeros, infinities, NaN and what is huge or tiny take the words as they are.
    const bool special = operation == OPERATION_FLOAT_COMPARE_SPECIAL || operation == OPERATION_FLOAT_SPECIAL_ADD ||
                         operation == OPERATION_FLOAT_SPECIAL_MULTIPLY;
    const float left = special ? floatOf(a) : operationModerate(a);
    const float right = special ? floatOf(b) : operationModerate(b);
    if (!operationOnFloats(operation, left, right, operationModerate(c), low, high) &&
        !operationOnWords(operation, a, b, low, high)) {
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
