// SPDX-License-Identifier: MIT
// Double precision by the device's own, for shaders of devices that have it and promise its rounding and its specials
// (FloatControls::doubles). Vulkan does not ask results of doubles to be as near as IEEE 754 does: that sums, differences,
// products and comparisons are the host's, with infinities and NaN too, is what operations.h asks of a device first. Of
// quotients it asks nothing, and a conversion may lose the denormals of floats: these are made of integers here, too.
// Denormals of doubles may get lost, and nothing rests on them: what floats and a grid are made of is larger by far.
#ifndef VOXTACT_WIDE_DOUBLES_GLSL
#define VOXTACT_WIDE_DOUBLES_GLSL

// Overloads for words must differ from these.
#define Wide WideIntegers
#define wideOfFloatBits wideIntegersOfFloatBits
#include "exact/wide_integers.h"
#undef Wide
#undef wideOfFloatBits
#undef wideBits

#define Wide double
#define wideBits(high, low) packDouble2x32(uvec2(low, high))

WideIntegers wideIntegersOf(double a) {
    const uvec2 words = unpackDouble2x32(a);
    return WideIntegers(words.x, words.y);
}

double wideOfIntegers(WideIntegers a) {
    return packDouble2x32(uvec2(a.low, a.high));
}

double wideOfFloatBits(uint bits) {
    return wideOfIntegers(wideIntegersOfFloatBits(bits));
}

uint wideToFloatBits(double a) {
    return wideToFloatBits(wideIntegersOf(a));
}

double wideAdd(double a, double b) {
    precise double sum = a + b;
    return sum;
}

double wideSubtract(double a, double b) {
    precise double difference = a - b;
    return difference;
}

double wideMultiply(double a, double b) {
    precise double product = a * b;
    return product;
}

double wideDivide(double a, double b) {
    return wideOfIntegers(wideDivide(wideIntegersOf(a), wideIntegersOf(b)));
}

double wideAbs(double a) {
    const uvec2 words = unpackDouble2x32(a);
    return packDouble2x32(uvec2(words.x, words.y & 0x7fffffffu));
}

bool wideLess(double a, double b) {
    return a < b;
}

bool wideAtLeast(double a, double b) {
    return a >= b;
}

#endif
