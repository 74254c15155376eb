// SPDX-License-Identifier: MIT
// Where clearances are measured: what is known of a pair, and how the passes with a margin read and better it. A step of
// the search looks as far as the pair asks (VOXTACT_CLEARANCE_ASKED), but never as far as is known already to have
// something opaque, less the tolerance: what is dropped is farther than both. Distances are flat, as in
// certified_margin.h; those of a pair only shrink during a step, and are compared as the words behind them.
#ifndef VOXTACT_CERTIFIED_CLEARANCE_GLSL
#define VOXTACT_CERTIFIED_CLEARANCE_GLSL

#include "certified_closest.glsl"

// Others better these words while they are read.
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) volatile buffer Live { uint live[]; };

uint clearanceWord(uint pair) {
#ifdef OF_LABEL
    return labelSearch[VOXTACT_LABEL_FIRST] + labelSearch[VOXTACT_LABEL_STRIDE] * pair;
#else
    return constants.queueWord + VOXTACT_WORD_CLEARANCES(constants.queueRoom) + VOXTACT_CLEARANCE_WORDS * pair;
#endif
}

/// What bounds are not brought nearer to each other than: most of the tolerance, or what rounding leaves.
float clearanceSpare(MarginSpace by, float distance) {
    return max(constants.item.resolution, distance * by.size * VOXTACT_CLEARANCE_ROUNDING);
}

/// Nothing farther is of use, where something is known to be as near as `hi`.
float clearanceLimit(MarginSpace by, float asked, float hi) {
    return min(asked, hi - clearanceSpare(by, hi));
}

float clearanceHi(uint pair) {
    return uintBitsToFloat(live[clearanceWord(pair) + VOXTACT_CLEARANCE_HI]);
}

float clearanceLo(uint pair) {
    return uintBitsToFloat(live[clearanceWord(pair) + VOXTACT_CLEARANCE_LO]);
}

float clearanceAsked(uint pair) {
#ifdef PROBE
    return VOXTACT_CLEARANCE_FAR; // what bounds the distance above may be farther
#else
    return uintBitsToFloat(live[clearanceWord(pair) + VOXTACT_CLEARANCE_ASKED]);
#endif
}

/// The margin of a pair at this moment. `grow` is that of the step, from beginning to end: who deals the work and who
/// does it must see the same boxes.
MarginSpace clearanceSpace(uint pair) {
    MarginSpace by = marginOf(constants.item);
    // The length of the vector of the rows' sums: less than the sum of these, which marginOf() has.
    const vec3 rows = vec3(abs(by.xx) + abs(by.xy) + abs(by.xz), abs(by.yy) + abs(by.yz), abs(by.zz));
    by.size = sqrt(dot(rows, rows)) * MARGIN_OUTWARD;
    const float asked = clearanceAsked(pair);
    by.grow = voxelPoint(by.grow.x * asked, by.grow.y * asked, by.grow.z * asked);
    by.margin = clearanceLimit(by, asked, clearanceHi(pair));
    return by;
}

#define MARGIN_SPACE(pair) clearanceSpace(pair)

/// Whether there is nothing left to be looked for.
bool clearanceIsDone(uint pair) {
    const uint word = clearanceWord(pair);
    return live[word + VOXTACT_CLEARANCE_ASKED] < VOXTACT_CLEARANCE_ENDS ||
           clearanceSpace(pair).margin <= clearanceLo(pair);
}

/// Stands for a distance of 0 to something that was looked at: the least number that arithmetic does not take for 0.
const float kNoDistance = 1.17549435e-38;

/// Something is left undecided, and may be as near. 0: nothing is known of it.
void leaveOpen(uint pair, float distance) {
    const uint least = distance > kNoDistance ? floatBitsToUint(distance)
                       : distance > 0.0       ? VOXTACT_CLEARANCE_AT_ONCE
                                              : VOXTACT_CLEARANCE_UNKNOWN;
    atomicMin(queues[clearanceWord(pair) + VOXTACT_CLEARANCE_OPEN], least);
}

/// Something is not looked at, as it is too much.
void refuse(uint pair) {
    atomicMin(queues[clearanceWord(pair) + VOXTACT_CLEARANCE_OPEN], VOXTACT_CLEARANCE_REFUSED);
}

/// Flat: a step that looks no farther than this beyond what is known does in place what has no room.
const float kLeastStep = 1.0;

/// Whether bricks that have no room are better refused: the next step looks less far, and to find them all in place
/// takes far longer than that.
bool mayLookLessFar(uint pair) {
    return clearanceAsked(pair) - clearanceLo(pair) > kLeastStep;
}

/// What a gap between shadows says at least of a distance.
float clearanceBelow(float gap, float square, float slack) {
    const float distance = gap * MARGIN_INWARD / sqrt(max(square, MARGIN_LEAST_SQUARE)) - slack;
    return square >= MARGIN_LEAST_SQUARE ? max(distance * MARGIN_INWARD, 0.0) : 0.0;
}

/// A triangle that has the point `near` is no farther from `at`.
float clearanceAbove(MarginSpace by, float slack, VoxelPoint near, VoxelPoint at) {
    const VoxelPoint way = marginFlat(by, voxelDifference(at, near));
    return (sqrt(voxelDot(way, way)) * MARGIN_OUTWARD + slack) * MARGIN_OUTWARD;
}

/// What a lane finds of a pair.
struct ClearanceFound {
    float hi;           // something opaque is as near
    float open;         // what is left undecided is not nearer
    ClosestPlace place; // of what is as near as `hi`, unless that was known before
};

ClearanceFound nothingFound() {
    return ClearanceFound(VOXTACT_CLEARANCE_FAR, VOXTACT_CLEARANCE_FAR, closestNowhere());
}

/// Turns at which a lane asks whether no other one writes: more than it takes, and no deadlock where it is not enough.
const uint kMostTurns = 1024;

/// Something opaque is as near to a triangle, or nearer. Who betters the distance writes what proves it, too, and one
/// lane per pair does so at a time: so what is kept always proves the distance that is. All that it touches is atomic,
/// and what ends its turn needs what came before; so that is seen in order without a memory barrier, which lavapipe
/// takes for one of the work group. What could not be told is left open: the next step finds it again.
void foundAt(uint pair, uint triangle, float distance, ClosestPlace place) {
    const uint hi = clearanceWord(pair) + VOXTACT_CLEARANCE_HI;
    if (!kClosest) {
        atomicMin(queues[hi], floatBitsToUint(distance));
        return;
    }
    const uint word = closestWord(pair);
    bool told = false;
    for (uint turn = 0; turn < kMostTurns && !told; ++turn) {
        if (distance >= clearanceHi(pair)) {
            told = true;
        } else if (atomicCompSwap(queues[word + VOXTACT_CLOSEST_TAKEN], 0u, 1u) == 0u) {
            uint before = atomicMin(queues[hi], floatBitsToUint(distance));
            if (before > floatBitsToUint(distance)) {
                before |= writeClosest(word, triangle, place);
            }
            const uint none = uint(constants.item.tableSize) >> 30; // 0, which compilers cannot know
            atomicExchange(queues[word + VOXTACT_CLOSEST_TAKEN], before & none);
            told = true;
        }
    }
    if (!told) {
        leaveOpen(pair, 0.0);
    }
}

#endif
