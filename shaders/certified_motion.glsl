// SPDX-License-Identifier: MIT
// With MOVE: the piece of a pair's way that is looked at. Expects certified_queues.glsl, `results`, and `constants`.
#ifndef VOXTACT_CERTIFIED_MOTION_GLSL
#define VOXTACT_CERTIFIED_MOTION_GLSL

#include "motion_words.h"

uint motionWord(uint pair) {
    // The results have as many elements as there is room for pairs.
    return constants.queueWord + VOXTACT_WORD_MOTION_STATES(constants.queueRoom, uint(results.length())) +
           VOXTACT_MOTION_STATE_WORDS * pair;
}

float motionFloat(uint word) {
    return uintBitsToFloat(queues[word]);
}

VoxelPoint motionPoint(uint word) {
    return voxelPoint(motionFloat(word), motionFloat(word + 1), motionFloat(word + 2));
}

MarginSpace moveSpace(uint pair) {
    const uint word = motionWord(pair);
    const uint at = word + VOXTACT_MOTION_MOVE;
    MarginSpace by = marginOf(constants.item);
    by.move.turningX = motionPoint(at);
    by.move.turningY = motionPoint(at + 3);
    by.move.turningZ = motionPoint(at + 6);
    by.move.centre = motionPoint(at + 9);
    by.move.speed = motionPoint(at + 12);
    by.move.straight = motionPoint(at + 15);
    by.move.bend = motionFloat(at + 18);
    by.move.slack = motionFloat(at + 19);
    by.pivot = by.move.centre;
    by.margin = by.move.slack;
    by.leastSide = motionFloat(word + VOXTACT_MOTION_LEAST_SIDE);
    return by;
}

/// VOXTACT_MOTION_ALL, _BOXES or _NONE.
uint motionLook(uint pair) {
    return queues[motionWord(pair) + VOXTACT_MOTION_LOOK];
}

#endif
