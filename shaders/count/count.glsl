// SPDX-License-Identifier: MIT
// Adds to the counter of a pair, which with kYesNo is 0 or 1. Expects `results`, `kCarry` and `kYesNo`.
#ifndef VOXTACT_COUNT_GLSL
#define VOXTACT_COUNT_GLSL

/// Adds passing fragments, at least one. Exact to 64 bits: the addition that wraps the low word carries one.
void addSurvivors(uint pair, uint survivors) {
    if (kYesNo) {
        atomicOr(results[pair].countLow, 1u);
        return;
    }
    const uint before = atomicAdd(results[pair].countLow, survivors);
    if (kCarry && before > 0xffffffffu - survivors) {
        atomicAdd(results[pair].countHigh, 1u);
    }
}

/// Adds high * 2^32 + low.
void addSurvivors(uint pair, uint low, uint high) {
    if (low > 0) {
        addSurvivors(pair, low);
    }
    if (high > 0) {
        atomicAdd(results[pair].countHigh, high);
    }
}

#endif
