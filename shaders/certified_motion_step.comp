// SPDX-License-Identifier: MIT
// Where motions are looked at, between two looks: a lane a segment takes what was seen of a piece of its way, and sets up
// the next one: the pair as it is in the middle of the piece, and how far it goes to both sides. A piece that is not
// free is halved, the earlier half first; of what comes after a touch nothing is looked at. So does SegmentSearch of the
// host (src/cpu/motion).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#ifndef DOUBLES // with them it is small anyway
#define SMALL_PROGRAM
#endif
#include "motion_words.h"
#include "pair_setup.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;

layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) writeonly buffer Transforms {
    CertifiedPair transforms[];
};
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) buffer Words { uint words[]; };
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_RESULTS, std430) buffer Results { PairResult results[]; };
layout(push_constant) uniform Motion { MotionConstants constants; };

#include "open_pairs.glsl"
#include "pair_grid.glsl"
#include "rigid_pose.h"

float floatAt(uint word) {
    return uintBitsToFloat(words[word]);
}

/// piece / 2^level, to the last bit.
float parameterOf(uint piece, uint level) {
    return float(piece) * uintBitsToFloat((127u - level) << 23);
}

struct Search {
    uint piece;
    uint level;
    uint phase;
    float freeUntil;
    float touchAt;
};

/// The next piece, after which nothing of this one is looked at.
void goOn(inout Search search) {
    ++search.piece;
    while (search.level > 0u && (search.piece & 1u) == 0u) {
        search.piece >>= 1;
        --search.level;
    }
    const float from = parameterOf(search.piece, search.level);
    search.phase = from >= min(search.touchAt, 1.0) ? VOXTACT_MOTION_DONE : VOXTACT_MOTION_ON_WAY;
}

/// Flat, of half a piece.
float halfLength(uint at, Search search) {
    return floatAt(at + VOXTACT_MOTION_LENGTH) * parameterOf(1, search.level + 1);
}

/// Whether a piece is not halved any more.
bool isLast(uint at, Search search) {
    const float from = parameterOf(search.piece, search.level);
    const float graze = search.freeUntil < from ? VOXTACT_MOTION_COARSER * (from - search.freeUntil) : 0.0;
    return search.level == VOXTACT_MOTION_MOST_LEVEL ||
           (parameterOf(1, search.level) <= max(floatAt(at + VOXTACT_MOTION_FINEST), graze) &&
            halfLength(at, search) <= VOXTACT_MOTION_FARTHEST);
}

/// What was seen of a piece.
void takePiece(uint at, bool touches, bool isFree, inout Search search) {
    const float to = parameterOf(search.piece + 1, search.level);
    if (touches) {
        search.touchAt = parameterOf(2 * search.piece + 1, search.level + 1);
    }
    if (isFree) {
        const bool grazes = search.freeUntil < parameterOf(search.piece, search.level);
        search.freeUntil = grazes ? search.freeUntil : to;
        goOn(search);
    } else if (!isLast(at, search)) {
        search.piece *= 2;
        ++search.level;
    } else if (!touches && to == 1.0) {
        search.phase = VOXTACT_MOTION_AT_TO;
    } else {
        goOn(search); // what follows is looked at in its own middle
    }
}

void take(uint at, bool touches, bool isFree, inout Search search) {
    if (search.phase == VOXTACT_MOTION_ON_WAY) {
        takePiece(at, touches, isFree, search);
        return;
    }
    if (touches) {
        search.touchAt = search.phase == VOXTACT_MOTION_AT_TO ? 1.0 : 0.0;
    }
    const bool begins = search.phase == VOXTACT_MOTION_AT_FROM && !touches;
    search.phase = begins ? VOXTACT_MOTION_ON_WAY : VOXTACT_MOTION_DONE;
}

/// Where a pair touches: a place in a cell, about its corner.
void keepTouch(uint pair, uint result) {
    const uint closest = constants.closestWord + VOXTACT_CLOSEST_WORDS * pair;
    const uint cell = closest + VOXTACT_CLOSEST_CELL;
    const uint from = closest + VOXTACT_CLOSEST_FROM;
    const vec3 place = vec3(ivec3(words[cell], words[cell + 1], words[cell + 2])) +
                       vec3(floatAt(from), floatAt(from + 1), floatAt(from + 2));
    for (uint row = 0; row < 3; ++row) {
        const vec3 along = vec3(constants.rows[3 * row], constants.rows[3 * row + 1], constants.rows[3 * row + 2]);
        words[result + VOXTACT_MOTION_POSITION + row] = floatBitsToUint(constants.origin[row] + dot(along, place));
    }
    words[result + VOXTACT_MOTION_TRIANGLE] = words[closest + VOXTACT_CLOSEST_TRIANGLE];
}

/// What there is to say of a segment in the end.
void end(uint pair, uint at, uint result, Search search) {
    const bool touches = search.touchAt <= 1.0;
    const bool possible = !touches && search.freeUntil < 1.0;
    const bool near = touches && search.touchAt - search.freeUntil <= floatAt(at + VOXTACT_MOTION_RESOLUTION);
    uint how = VOXTACT_MOTION_DECIDED;
    if (search.phase != VOXTACT_MOTION_DONE) {
        how = VOXTACT_MOTION_BUDGET;
    } else if (possible || (touches && !near)) {
        how = VOXTACT_MOTION_GRAZES;
    }
    words[result + VOXTACT_MOTION_END] = how;
    results[pair].countLow = touches ? 1 : 0;
    results[pair].how = (results[pair].how & ~VOXTACT_HOW_UNDECIDED_BIT) | (possible ? VOXTACT_HOW_UNDECIDED_BIT : 0);
}

#include "exact_language.h"

/// A vector of the world in voxel space; or, with `place`, a place.
vec3 voxelOf(PairGrid grid, RigidPose pose, uint first, bool place) {
    vec3 found;
    ROLLED for (uint row = 0; row < 3; ++row) {
        Wide sum = wideMultiply(grid.texture_from_world.element[row], pose.number[first]);
        if (place) {
            sum = wideAdd(grid.texture_from_world.element[12 + row], sum);
        }
        ROLLED for (uint k = 1; k < 3; ++k) {
            sum = wideAdd(sum, wideMultiply(grid.texture_from_world.element[4 * k + row], pose.number[first + k]));
        }
        sum = wideMultiply(sum, grid.size[row]);
        if (place) {
            sum = wideSubtract(sum, PAIR_HALF);
        }
        found[row] = wideFloatOf(wideToFloatBits(sum));
    }
    return found;
}

/// The pair as it is in the middle of the piece, or at the end.
void setUp(uint pair, uint at, Search search) {
    const float middle = parameterOf(2 * search.piece + 1, search.level + 1);
    const PairGrid grid = gridAt(constants.setupWord);
    RigidPose pose = rigidPose(RigidWay(at + VOXTACT_MOTION_WAY), wideOfFloatBits(floatBitsToUint(middle)));
    if (search.phase == VOXTACT_MOTION_AT_TO) {
        ROLLED for (int i = 0; i < 12; ++i) {
            pose.number[i] = wideAt(at + VOXTACT_MOTION_TO + 2 * i);
        }
    }
    transforms[pair] = certifiedPairOf(grid, rigidMatrix(pose));
    vec3 places[2]; // the centre's place, and its speed
    ROLLED for (uint i = 0; i < 2; ++i) {
        places[i] = voxelOf(grid, pose, RIGID_CENTRE + 3 * i, i == 0);
    }
    const float share = parameterOf(1, search.level + 1);
    const uint to = at + VOXTACT_MOTION_MOVE;
    ROLLED for (uint i = 0; i < 9; ++i) {
        words[to + i] = floatBitsToUint(floatAt(at + VOXTACT_MOTION_TURNING + i) * share);
    }
    ROLLED for (uint i = 0; i < 3; ++i) {
        words[to + 9 + i] = floatBitsToUint(places[0][i]);
        words[to + 12 + i] = floatBitsToUint(places[1][i] * share);
        words[to + 15 + i] = floatBitsToUint(floatAt(at + VOXTACT_MOTION_STRAIGHT + i) * share);
    }
    words[to + 18] = floatBitsToUint(floatAt(at + VOXTACT_MOTION_BEND) * share);
    words[to + 19] = floatBitsToUint(floatAt(at + VOXTACT_MOTION_DEFORMATION) * share +
                                     floatAt(at + VOXTACT_MOTION_ROUNDING));
    const float length = halfLength(at, search);
    const float finest = isLast(at, search) ? 0.0 : 2.0 * length * VOXTACT_MOTION_FINEST_BOX;
    words[at + VOXTACT_MOTION_LEAST_SIDE] = floatBitsToUint(finest);
    uint look = VOXTACT_MOTION_ALL;
    if (search.phase == VOXTACT_MOTION_AT_TO) {
        look = VOXTACT_MOTION_NONE;
    } else if (length > VOXTACT_MOTION_FARTHEST) {
        look = VOXTACT_MOTION_BOXES;
    }
    words[at + VOXTACT_MOTION_LOOK] = look;
}

#include "exact_language.h"

void main() {
    if (gl_GlobalInvocationID.x >= constants.pairs) {
        return;
    }
    const uint pair = constants.firstPair + gl_GlobalInvocationID.x;
    const uint at = constants.stateWord + VOXTACT_MOTION_STATE_WORDS * pair;
    const uint result = constants.resultWord + VOXTACT_MOTION_RESULT_WORDS * pair;
    Search search = Search(words[at + VOXTACT_MOTION_PIECE], words[at + VOXTACT_MOTION_LEVEL],
                           words[at + VOXTACT_MOTION_PHASE], floatAt(result + VOXTACT_MOTION_FREE_UNTIL),
                           floatAt(result + VOXTACT_MOTION_TOUCH_AT));
    if (constants.what != VOXTACT_MOTION_FIRST_STEP && search.phase != VOXTACT_MOTION_DONE) {
        const uint count = results[pair].countLow;
        const bool touches = (count & ~VOXTACT_MOTION_MET) != 0u;
        take(at, touches, count == 0u, search);
        if (touches) {
            keepTouch(pair, result);
        }
        words[at + VOXTACT_MOTION_PIECE] = search.piece;
        words[at + VOXTACT_MOTION_LEVEL] = search.level;
        words[at + VOXTACT_MOTION_PHASE] = search.phase;
        words[result + VOXTACT_MOTION_FREE_UNTIL] = floatBitsToUint(search.freeUntil);
        words[result + VOXTACT_MOTION_TOUCH_AT] = floatBitsToUint(search.touchAt);
    }
    if (constants.what == VOXTACT_MOTION_LAST_STEP) {
        end(pair, at, result, search);
        return;
    }
    emptyNext(constants.open, gl_GlobalInvocationID.x);
    if (search.phase == VOXTACT_MOTION_DONE) {
        return;
    }
    listPair(constants.open, pair);
    results[pair].countLow = 0;
    words[constants.closestWord + VOXTACT_CLOSEST_WORDS * pair + VOXTACT_CLOSEST_TAKEN] = 0;
    // A loop, which is left at once where none is set up: a branch would not be, on a processor. The first pose has
    // been set up already.
    [[dont_unroll]] for (uint turn = search.phase == VOXTACT_MOTION_AT_FROM ? 1u : 0u; turn < 1u; ++turn) {
        setUp(pair, at, search);
    }
}
