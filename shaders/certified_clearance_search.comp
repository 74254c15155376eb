// SPDX-License-Identifier: MIT
// Where clearances are measured, between two steps: a lane per pair sees what the step has found, and how far the next
// one is to look. What a step has looked at completely is farther than it asked, than what was found less the
// tolerance, or than what was left undecided, whichever is nearest.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;

layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) buffer Words { uint words[]; };
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_RESULTS, std430) readonly buffer Results {
    PairResult results[];
};
layout(push_constant) uniform Search { ClearanceConstants constants; };

#include "open_pairs.glsl"

#define INFINITE uintBitsToFloat(0x7f800000u)
/// Of a distance in mm: more than rounding does to it.
const float kInward = 0.99999905;
const float kOutward = 1.00000095;
/// Flat: something certain is looked for up to so far beyond twice the distance of what was left undecided.
const float kFarBeyond = 16.0;

struct State {
    float lo;
    float hi;
    float asked;
    uint open;
};

void write(uint at, float lo, float hi, uint third, uint fourth) {
    words[at + VOXTACT_CLEARANCE_LO] = floatBitsToUint(lo);
    words[at + VOXTACT_CLEARANCE_HI] = floatBitsToUint(hi);
    words[at + VOXTACT_CLEARANCE_ASKED] = third;
    words[at + VOXTACT_CLEARANCE_OPEN] = fourth;
}

/// Whether what is known of all that is opaque ends the search for a label: nothing is, or nothing near enough.
bool isKnown(uint at, uint pair) {
    if (constants.allWord == VOXTACT_NO_WORD) {
        return false;
    }
    const uint of = constants.allWord + VOXTACT_CLEARANCE_WORDS * pair;
    const bool nothing = words[of + VOXTACT_CLEARANCE_LO] == floatBitsToUint(INFINITE);
    if (!nothing && words[of + VOXTACT_CLEARANCE_ASKED] != VOXTACT_CLEARANCE_BEYOND) {
        return false;
    }
    for (uint i = 0; i < VOXTACT_CLEARANCE_WORDS; ++i) {
        words[at + i] = words[of + i];
    }
    return true;
}

void begin(uint at, uint pair, PairResult touch) {
    if (constants.steps == 0) {
        write(at, INFINITE, INFINITE, VOXTACT_CLEARANCE_CLOSED, 0);
    } else if (constants.ofLabel == 0 && (touch.countLow != 0 || touch.countHigh != 0)) {
        write(at, 0.0, 0.0, VOXTACT_CLEARANCE_CLOSED, 0);
    } else if (VOXTACT_HOW_EXACTNESS(touch.how) == VOXTACT_EXACTNESS_REFUSED) {
        write(at, 0.0, INFINITE, VOXTACT_CLEARANCE_ROUNDED, 0);
    } else if (!isKnown(at, pair)) {
        write(at, 0.0, VOXTACT_CLEARANCE_FAR, floatBitsToUint(constants.most),
              floatBitsToUint(VOXTACT_CLEARANCE_FAR));
    }
}

/// The search of a pair ends. `complete`: all was looked at that may be nearer.
void end(uint at, State found, bool mayTouch, bool complete) {
    if (found.lo >= constants.most && !mayTouch) {
        const bool nothing = constants.most >= VOXTACT_CLEARANCE_FAR;
        write(at, nothing ? INFINITE : constants.maximum, INFINITE,
              nothing ? VOXTACT_CLEARANCE_CLOSED : VOXTACT_CLEARANCE_BEYOND, 0);
        return;
    }
    const float lo = mayTouch ? 0.0 : found.lo * constants.side * kInward;
    const float hi = found.hi < VOXTACT_CLEARANCE_FAR ? found.hi * constants.side * kOutward : INFINITE;
    const uint how = hi - lo <= constants.closed ? VOXTACT_CLEARANCE_CLOSED
                     : complete                  ? VOXTACT_CLEARANCE_ROUNDED
                                                 : VOXTACT_CLEARANCE_BUDGET;
    write(at, lo, hi, how, 0);
}

void search(uint at, bool mayTouch) {
    State found = State(uintBitsToFloat(words[at + VOXTACT_CLEARANCE_LO]),
                        uintBitsToFloat(words[at + VOXTACT_CLEARANCE_HI]),
                        uintBitsToFloat(words[at + VOXTACT_CLEARANCE_ASKED]), words[at + VOXTACT_CLEARANCE_OPEN]);
    const bool boxesOnly = constants.step == 1;
    const float farther = found.asked - found.lo; // than what was known before
    const bool refused = found.open == VOXTACT_CLEARANCE_REFUSED;
    const float open = found.open <= VOXTACT_CLEARANCE_AT_ONCE ? 0.0 : uintBitsToFloat(found.open);
    const bool some = found.hi < VOXTACT_CLEARANCE_FAR;
    const float useful =
        min(some ? found.hi - max(constants.tolerance, found.hi * constants.rounding) : constants.most, constants.most);
    const bool complete = found.asked >= useful && !refused;
    found.lo = max(found.lo, min(min(found.asked, useful), open));
    // What was left undecided may be decided where more is known: once more, as long as that helps.
    const bool again = some && found.asked > found.hi && open < useful;
    // Nothing is certain anywhere near what rounding left undecided: to look on would better the upper bound alone.
    const bool lost = !some && !refused && !boxesOnly && found.open >= VOXTACT_CLEARANCE_AT_ONCE &&
                      found.asked >= 2.0 * open + kFarBeyond;
    if (found.lo >= useful || constants.step == constants.steps || lost || (complete && !again && !boxesOnly)) {
        end(at, found, mayTouch, complete || lost);
        return;
    }
    float asked = constants.most;
    if (refused) {
        asked = found.lo + min(farther, useful - found.lo) * 0.25; // it was too much
    } else if (boxesOnly) {
        asked = found.lo + constants.first;
    } else if (!some && constants.step < constants.lastStep - 1) {
        asked = max(found.lo, found.asked) + 2.0 * farther;
    }
    asked = min(asked, constants.most);
    write(at, found.lo, found.hi, floatBitsToUint(some ? min(asked, found.hi) : asked),
          floatBitsToUint(VOXTACT_CLEARANCE_FAR));
}

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= constants.pairs) {
        return;
    }
    const uint pair = constants.firstPair + i;
    const uint at = constants.clearanceWord + constants.pairWords * pair;
    emptyNext(constants.open, i);
    if (constants.step == 0) {
        begin(at, pair, results[pair]);
    } else if (words[at + VOXTACT_CLEARANCE_ASKED] >= VOXTACT_CLEARANCE_ENDS) {
        search(at, constants.ofLabel == 0 && VOXTACT_HOW_UNDECIDED(results[pair].how) != 0);
    }
    if (words[at + VOXTACT_CLEARANCE_ASKED] >= VOXTACT_CLEARANCE_ENDS) {
        listPair(constants.open, pair);
    }
}
