// SPDX-License-Identifier: MIT
// Where the closest points of pairs are wanted: what proves that something opaque is as near as VOXTACT_CLEARANCE_HI of
// a pair says, or, of a pair that touches, what proves the touch. Expects certified_queues.glsl, `results`, and
// `constants`.
#ifndef VOXTACT_CERTIFIED_CLOSEST_GLSL
#define VOXTACT_CERTIFIED_CLOSEST_GLSL

#include "clearance_words.h"

layout(constant_id = VOXTACT_CONSTANT_CLOSEST) const bool kClosest = false;

/// Something opaque: on the straight way between two points about the cell's corner (VOXTACT_CLOSEST_ON_WAY), or
/// anywhere in the cell (VOXTACT_CLOSEST_IN_CELL), or in the brick that has its first cell there.
struct ClosestPlace {
    uint kind;
    ivec3 cell;
    VoxelPoint from;
    VoxelPoint to;
};

ClosestPlace closestWay(ivec3 cell, VoxelPoint from, VoxelPoint to) {
    return ClosestPlace(VOXTACT_CLOSEST_ON_WAY, cell, from, to);
}

ClosestPlace closestIn(uint kind, ivec3 cell) {
    const VoxelPoint none = voxelPoint(0.0, 0.0, 0.0);
    return ClosestPlace(kind, cell, none, none);
}

ClosestPlace closestNowhere() {
    return closestIn(VOXTACT_CLOSEST_ON_WAY, ivec3(0));
}

uint closestWord(uint pair) {
    // The results have as many elements as there is room for pairs.
    return constants.queueWord + VOXTACT_WORD_CLOSEST(constants.queueRoom, uint(results.length())) +
           VOXTACT_CLOSEST_WORDS * pair;
}

uint writeWords(uint word, uvec3 words) {
    return atomicExchange(queues[word], words.x) | atomicExchange(queues[word + 1], words.y) |
           atomicExchange(queues[word + 2], words.z);
}

uint writePoint(uint word, VoxelPoint point) {
    return writeWords(word, floatBitsToUint(vec3(point.x, point.y, point.z)));
}

/// Returns bits of what was there: whoever has them knows that all is written.
uint writeClosest(uint word, uint triangle, ClosestPlace place) {
    return atomicExchange(queues[word + VOXTACT_CLOSEST_TRIANGLE], triangle) |
           atomicExchange(queues[word + VOXTACT_CLOSEST_KIND], place.kind) |
           writeWords(word + VOXTACT_CLOSEST_CELL, uvec3(place.cell)) |
           writePoint(word + VOXTACT_CLOSEST_FROM, place.from) | writePoint(word + VOXTACT_CLOSEST_TO, place.to);
}

/// The first touch of a pair that is kept has its closest points: a place in a cell, about its corner.
void keepTouch(uint pair, uint triangle, ivec3 cell, VoxelPoint at) {
    const uint word = closestWord(pair);
    if (atomicCompSwap(queues[word + VOXTACT_CLOSEST_TAKEN], 0u, 1u) == 0u) {
        writeClosest(word, triangle, closestWay(cell, at, at));
    }
}

#endif
