// SPDX-License-Identifier: MIT
#ifndef VOXTACT_ORDERED_GLSL
#define VOXTACT_ORDERED_GLSL

/// Words that have the order of the floats behind them: VOXTACT_BOUND_BITS() is the way back. None is 0.
uint orderedWord(float value) {
    const uint bits = floatBitsToUint(value);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

#endif
