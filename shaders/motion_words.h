// SPDX-License-Identifier: MIT
// What the search along motions has behind the queues of shared.h and what clearance_words.h has there. One text for
// GLSL and C++.
#ifndef VOXTACT_MOTION_WORDS_H
#define VOXTACT_MOTION_WORDS_H

#include "clearance_words.h"

// From multiples of 256 bytes on, of each pair, which is the segment that begins with its pose: a MotionResult, and
// then a MotionState. `pairs`: as many as there is room for.
#define VOXTACT_MOTION_RESULT_WORDS 8
#define VOXTACT_WORD_MOTIONS(room, pairs)                                                                              \
    (VOXTACT_WORD_CLOSEST(room, pairs) + ((pairs)*VOXTACT_CLOSEST_WORDS + 63) / 64 * 64)
#define VOXTACT_WORD_MOTION_STATES(room, pairs)                                                                        \
    (VOXTACT_WORD_MOTIONS(room, pairs) + ((pairs)*VOXTACT_MOTION_RESULT_WORDS + 63) / 64 * 64)

// Words of a MotionResult.
#define VOXTACT_MOTION_FREE_UNTIL 0
#define VOXTACT_MOTION_TOUCH_AT 1
#define VOXTACT_MOTION_END 2
#define VOXTACT_MOTION_TRIANGLE 3
#define VOXTACT_MOTION_POSITION 4 // three floats
#define VOXTACT_MOTION_LAST 7

// Words of a MotionState. First the piece of the way that is looked at, from piece / 2^level to (piece + 1) / 2^level.
#define VOXTACT_MOTION_PIECE 0
#define VOXTACT_MOTION_LEVEL 1
#define VOXTACT_MOTION_PHASE 2
#define VOXTACT_MOTION_LOOK 3
// Of half of that piece, as MoveWay of certified_move.h has it: the rows of `turning`, `centre`, `speed`, `straight`,
// `bend` and `slack`; and the least side of a box of a cell.
#define VOXTACT_MOTION_MOVE 4
#define VOXTACT_MOTION_LEAST_SIDE 24
// The RigidWay of the segment, and the pose at its end: of each double the low word first.
#define VOXTACT_MOTION_WAY 28
#define VOXTACT_MOTION_TO 248
// Of the whole way: MoveWay's `turning`, `straight`, `bend`; what is no rigid motion, and what a pose is rounded by,
// flat; its length, flat, of the fastest point; the part of it that is not halved any more, and that within which a
// touch is decided.
#define VOXTACT_MOTION_TURNING 272
#define VOXTACT_MOTION_STRAIGHT 281
#define VOXTACT_MOTION_BEND 284
#define VOXTACT_MOTION_DEFORMATION 285
#define VOXTACT_MOTION_ROUNDING 286
#define VOXTACT_MOTION_LENGTH 287
#define VOXTACT_MOTION_FINEST 288
#define VOXTACT_MOTION_RESOLUTION 289
#define VOXTACT_MOTION_STATE_WORDS 290
// Phases.
#define VOXTACT_MOTION_AT_FROM 0u // the first pose is looked at
#define VOXTACT_MOTION_ON_WAY 1u  // a piece, and the pose in its middle
#define VOXTACT_MOTION_AT_TO 2u   // the last pose
#define VOXTACT_MOTION_DONE 3u
// What a step does.
#define VOXTACT_MOTION_FIRST_STEP 0u // nothing is looked at yet
#define VOXTACT_MOTION_NEXT_STEP 1u
#define VOXTACT_MOTION_LAST_STEP 2u // no look comes after it
// How a piece is looked at.
#define VOXTACT_MOTION_ALL 0u   // down to cells
#define VOXTACT_MOTION_BOXES 1u // it is long: what boxes of some triangles do not exclude is not free
#define VOXTACT_MOTION_NONE 2u  // only the pose is

// How a way is looked at, by the host and by a device.
/// Of the resolution, a piece that is not halved any more: a touch that begins just where two of them meet is seen in
/// the middle of the second.
#define VOXTACT_MOTION_LAST_PIECE 0.25f
/// Where a graze has been found, only a touch is still looked for, at places that are this part of the way from there.
#define VOXTACT_MOTION_COARSER 0.5f
/// Of the length of a piece: no box of a volume is looked at that is smaller, unless the piece is not halved any more.
#define VOXTACT_MOTION_FINEST_BOX 0.0625f

/// Flat: what goes farther in half a piece is looked at by boxes alone. How much a dispatch has to do follows from it.
#define VOXTACT_MOTION_FARTHEST 4.0f
/// No piece is shorter than 2^-22 of the way: so parameters are floats, to the last bit.
#define VOXTACT_MOTION_MOST_LEVEL 22u
/// In PairResult::countLow, beside the count, while pieces are looked at: some of the piece is not free.
#define VOXTACT_MOTION_MET 0x80000000u

#ifdef __cplusplus
#include "rigid_pose.h"

namespace voxtact::shader {

struct MotionState {
    uint piece, level, phase, look;
    float move[20];
    float leastSide;
    uint unused[3];
    RigidWay way;
    Wide to[12];
    float turning[9];
    float straight[3];
    float bend;
    float deformation;
    float rounding;
    float length;
    float finest;
    float resolution;
};
static_assert(sizeof(MotionState) == sizeof(uint) * VOXTACT_MOTION_STATE_WORDS);
static_assert(offsetof(MotionState, way) == sizeof(uint) * VOXTACT_MOTION_WAY &&
              offsetof(MotionState, to) == sizeof(uint) * VOXTACT_MOTION_TO &&
              offsetof(MotionState, leastSide) == sizeof(uint) * VOXTACT_MOTION_LEAST_SIDE &&
              offsetof(MotionState, turning) == sizeof(uint) * VOXTACT_MOTION_TURNING &&
              offsetof(MotionState, resolution) == sizeof(uint) * VOXTACT_MOTION_RESOLUTION);
static_assert(offsetof(RigidWay, term) == 2 * sizeof(Wide), "as rigid_pose.h reads it");

} // namespace voxtact::shader
#endif

#endif
