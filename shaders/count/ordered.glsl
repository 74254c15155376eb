// SPDX-License-Identifier: MIT
#ifndef VOXTACT_ORDERED_GLSL
#define VOXTACT_ORDERED_GLSL

/// Words with the order of their floats; VOXTACT_BOUND_BITS() is the inverse. No word is 0.
uint orderedWord(float value) {
    const uint bits = floatBitsToUint(value);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

#endif
