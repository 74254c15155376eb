// SPDX-License-Identifier: MIT
// What the search for clearances has behind the queues of shared.h, in words. One text for GLSL and C++.
#ifndef VOXTACT_CLEARANCE_WORDS_H
#define VOXTACT_CLEARANCE_WORDS_H

#include "open_pairs.h"
#include "shared.h"

// The bits of the cells of some bricks: of each slot the number of its brick and one, or 0; then the slots that are to
// be filled; then of each the words of its bits.
#define VOXTACT_ROOM_BITS(room) (room)
#define VOXTACT_WORD_BITS(room) VOXTACT_QUEUE_WORDS(room)
#define VOXTACT_WORD_BITS_WANTED(room) (VOXTACT_WORD_BITS(room) + VOXTACT_ROOM_BITS(room))
#define VOXTACT_WORD_BITS_WORDS(room) (VOXTACT_WORD_BITS_WANTED(room) + VOXTACT_ROOM_BITS(room))
/// Of a slot: a bit for each cell that may have something opaque, x fastest, and as many for those that certainly have.
#define VOXTACT_BITS_WORDS 32
// The queue of large triangles, which far from anything has many more entries than with a margin: a brick is listed for
// all that may be nearer than what is known, whatever part of it is opaque. `room` is a multiple of 16.
#define VOXTACT_CLEARANCE_ROOM_LARGE(room) ((room)*16)
#define VOXTACT_WORD_CLEARANCE_LARGE(room)                                                                             \
    (VOXTACT_WORD_BITS_WORDS(room) + VOXTACT_BITS_WORDS * VOXTACT_ROOM_BITS(room))
// What is left lies in the words that both queues have without clearances.
#define VOXTACT_WORD_CLEARANCE_LEFT(room) VOXTACT_WORD_LARGE(room)
#define VOXTACT_CLEARANCE_ROOM_LEFT(room) (VOXTACT_ROOM_LARGE(room) + VOXTACT_ROOM_CELLS(room) / 4)
// Numbers of entries of the queue of large triangles: those of VOXTACT_QUEUE_NEAR; and those of VOXTACT_QUEUE_PROBES,
// and then of VOXTACT_QUEUE_NEAREST, which has a work group each, and no more than every device lets there be.
#define VOXTACT_WORD_NEAR(room) (VOXTACT_WORD_CLEARANCE_LARGE(room) + 4 * VOXTACT_CLEARANCE_ROOM_LARGE(room))
#define VOXTACT_WORD_NEAREST(room) (VOXTACT_WORD_NEAR(room) + VOXTACT_CLEARANCE_ROOM_LARGE(room))
#define VOXTACT_ROOM_NEAREST(room) ((room)*3)
// The queue of open cells, whose words others have with a margin: numbers of cells for certified_clearance_decide.
#define VOXTACT_WORD_CLEARANCE_OPEN(room) (VOXTACT_WORD_NEAREST(room) + VOXTACT_CLEARANCE_ROOM_LARGE(room))
// Of the label that a search is about, four words.
#define VOXTACT_WORD_LABEL(room) (VOXTACT_WORD_CLEARANCE_OPEN(room) + VOXTACT_ROOM_CELLS(room))
#define VOXTACT_LABEL_FIRST 0   // where the words of the first pair are
#define VOXTACT_LABEL_STRIDE 1  // from these to those of the next
#define VOXTACT_LABEL_NUMBER 2  // in the label map
#define VOXTACT_LABEL_CERTAIN 3 // not 0: the map has no more labels than VOXTACT_LABEL_BITS
/// Bits of each node of a label map: that of a label's number modulo it is set where a voxel of it is a corner of the
/// node's cells. 32 for each component of a uvec4.
#define VOXTACT_LABEL_BITS 128
// From a multiple of 256 bytes on: four words per pair, in the end its ClearanceResult.
#define VOXTACT_WORD_CLEARANCES(room) ((VOXTACT_WORD_LABEL(room) + 4 + 63) / 64 * 64)
// Behind the clearances, from a multiple of 256 bytes on, what open_pairs.h says. `pairs`: as many as there is room
// for.
#define VOXTACT_WORD_OPEN_PAIRS(room, pairs)                                                                           \
    (VOXTACT_WORD_CLEARANCES(room) + ((pairs)*VOXTACT_CLEARANCE_WORDS + 63) / 64 * 64)
// Where closest points are wanted, behind that, from a multiple of 256 bytes on: so many words per pair, in the end its
// ClosestResult.
#define VOXTACT_WORD_CLOSEST(room, pairs)                                                                              \
    (VOXTACT_WORD_OPEN_PAIRS(room, pairs) + (VOXTACT_OPEN_PAIRS_WORDS(pairs) + 63) / 64 * 64)
#define VOXTACT_CLOSEST_WORDS 12
// Behind all these, and what motion_words.h has there, from a multiple of 256 bytes on, where clearances to labels are
// wanted: four words for each label of a pair, label by label, and pair by pair.
// Before that, what proves VOXTACT_CLEARANCE_HI, or the touch: shaders/certified_closest.glsl.
#define VOXTACT_CLOSEST_TAKEN 0 // not 0: a lane writes, or the pair touches
#define VOXTACT_CLOSEST_TRIANGLE 1
#define VOXTACT_CLOSEST_KIND 2
#define VOXTACT_CLOSEST_CELL 3 // three ints
#define VOXTACT_CLOSEST_FROM 6 // three floats, about the cell's corner
#define VOXTACT_CLOSEST_TO 9
// Kinds.
#define VOXTACT_CLOSEST_ON_WAY 0u   // something is opaque on the straight way between the two points
#define VOXTACT_CLOSEST_IN_CELL 1u  // in the cell
#define VOXTACT_CLOSEST_IN_BRICK 2u // in the brick that has its first cell there

// The third word of an entry of the queue of large triangles is its brick; or this, and from the lowest bit on the
// brick's slot, a cell of the brick that is first on the way from the run, and the triangle that the way begins at.
#define VOXTACT_HAS_SLOT (1u << 31)
#define VOXTACT_FIRST_CELL_SHIFT 18
#define VOXTACT_FIRST_TRIANGLE_SHIFT (VOXTACT_FIRST_CELL_SHIFT + 3 * VOXTACT_BRICK_SHIFT)
// The fourth has, above the bits of the triangles, what the brick is no nearer to them than; and that of an entry of
// the queue of cells above its number along the third axis: in parts of a flat unit, from what the pair is known to be
// on.
#define VOXTACT_BELOW_SHIFT (VOXTACT_RUN_TRIANGLES + 1)
#define VOXTACT_BELOW_PARTS 256.0

#ifdef __cplusplus
static_assert(VOXTACT_WORD_CLEARANCE_LARGE(16) % 4 == 0 && VOXTACT_WORD_CLEARANCE_LEFT(16) % 4 == 0);
static_assert(VOXTACT_WORD_CLEARANCE_LEFT(16) + 4 * VOXTACT_CLEARANCE_ROOM_LEFT(16) <= VOXTACT_WORD_CLUSTERS(16));
static_assert(VOXTACT_RUN_TRIANGLES <= 1 << (31 - VOXTACT_FIRST_TRIANGLE_SHIFT));
static_assert(VOXTACT_ROOM_NEAREST(16) <= VOXTACT_CLEARANCE_ROOM_LARGE(16));
#endif

#endif
