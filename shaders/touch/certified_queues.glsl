// SPDX-License-Identifier: MIT
// The queues between the passes of the projection `certified`: shared.h says where they lie. A work group puts all
// that it has into a queue at once, with one atomic for the place and one for the work groups of the pass that empties
// it. Expects `constants`, `kCounters` and brickCounts().
#ifndef VOXTACT_CERTIFIED_QUEUES_GLSL
#define VOXTACT_CERTIFIED_QUEUES_GLSL

// Behind the transforms, in the same buffer.
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) buffer Queues { uint queues[]; };
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) buffer Quads { uvec4 quads[]; };

#define LARGE_WORD VOXTACT_WORD_LARGE(constants.queueRoom)
#define LARGE_ROOM VOXTACT_ROOM_LARGE(constants.queueRoom)
#define LEFT_WORD VOXTACT_WORD_LEFT(constants.queueRoom)
#define LEFT_ROOM VOXTACT_ROOM_LEFT(constants.queueRoom)

uint queueCount(uint queue) {
    return queues[constants.headerWord + 4 * queue + 3];
}

/// Adds to a VOXTACT_WORK_* of the round, where that is asked for.
void countWork(uint word, uint work) {
    if (kCounters && work > 0) {
        atomicAdd(queues[constants.headerWord + word], work);
    }
}

/// Room for `entries` of a queue, and work groups of `lanes` entries each for the pass that empties it, as far as the
/// queue has room. Returns the number of the first; those from `room` on are not there.
uint reserve(uint queue, uint entries, uint room, uint lanes) {
    const uint word = constants.headerWord + 4 * queue;
    const uint before = atomicAdd(queues[word + 3], entries);
    const uint first = min(before, room);
    const uint end = min(before + entries, room);
    const uint groups = (end + lanes - 1) / lanes - (first + lanes - 1) / lanes;
    if (groups > 0) {
        atomicAdd(queues[word], groups);
    }
    return before;
}

/// Number of the element of `quads` where entry `entry` of a queue of four words begins.
uint quadOf(uint word, uint entry) {
    return (constants.queueWord + word) / 4 + entry;
}

/// A voxel cell in two words.
uvec2 packCell(ivec3 cell) {
    return uvec2(uint(cell.x + 1) | uint(cell.y + 1) << 16, uint(cell.z + 1));
}

ivec3 unpackCell(uvec2 words) {
    return ivec3(words.x & 0xffffu, words.x >> 16, words.y) - 1;
}

/// Instead of a pair: the entry is a gap.
const uint kNoPair = 0xffffffffu;

/// What is left of a triangle is dealt to work groups of certified_finish by so many bricks; of small triangles, each
/// of these work groups has one of so many shares of the cells. No lane then has more than some tens of cells, however
/// large the triangles are.
const uint kBricksOfGroup = 8;
const uint kSharesOfSmall = 3;

uint groupsOfBricks(uint bricks) {
    return (bricks + kBricksOfGroup - 1) / kBricksOfGroup;
}

/// Looks at cells that a work group of certified_finish has, at most.
const uint kLooksOfGroup = kBricksOfGroup << (3 * VOXTACT_BRICK_SHIFT);

/// Work groups of certified_finish in a round, at most. What is beyond is refused.
uint mostGroupsLeft() {
    // The host bounds looks, and boxes of large triangles have more bricks than these pass through: some dozens of
    // times as many. It cannot bound those of triangles that it does not know, nor cut what one cluster has: that may be
    // left once as a whole, and in parts as well.
    const uint kMost = VOXTACT_LEFT_LAYER * VOXTACT_LEFT_MOST_LAYERS;
    const ivec3 size = brickCounts();
    const uint whole = groupsOfBricks(uint(size.x * size.y * size.z)) + kBricksOfGroup;
    const uint ofCluster = min(whole, kMost / VOXTACT_CLUSTER_TRIANGLES) * VOXTACT_CLUSTER_TRIANGLES +
                           LARGE_ROOM * VOXTACT_RUN_TRIANGLES;
    return min(max(constants.queueRoom * VOXTACT_GROUPS_OF_CLUSTER, ofCluster), kMost);
}

uint leftBlockWord(uint block) {
    return constants.queueWord + VOXTACT_WORD_LEFT_BLOCKS(constants.queueRoom) + block;
}

/// A share, of `lanes`, of making the blocks of what is left empty: for the first pass of a round.
void emptyLeftBlocks(uint lane, uint lanes) {
    for (uint block = lane; block * VOXTACT_LEFT_BLOCK < LEFT_ROOM; block += lanes) {
        queues[leftBlockWord(block)] = 0;
    }
}

/// An entry of certified_finish, for which it needs `groups` work groups. False: it is refused, and what it has of its
/// pairs is not known.
bool leave(uint what, uint number, uint brick, uint groups) {
    const uint word = constants.headerWord + 4 * VOXTACT_QUEUE_LEFT;
    // Never more than the most, not even for a moment: the sum of all that is refused may not fit into a word.
    uint first = 0;
    uint seen = queues[constants.headerWord + VOXTACT_GROUPS_LEFT];
    do {
        first = seen;
        if (groups > mostGroupsLeft() || first > mostGroupsLeft() - groups) {
            return false;
        }
        seen = atomicCompSwap(queues[constants.headerWord + VOXTACT_GROUPS_LEFT], first, first + groups);
    } while (seen != first);
    if (seen != first) {
        return false; // the loop was cut (certified_scene.glsl)
    }
    const uint layers = (first + groups + VOXTACT_LEFT_LAYER - 1) / VOXTACT_LEFT_LAYER -
                        (first + VOXTACT_LEFT_LAYER - 1) / VOXTACT_LEFT_LAYER;
    atomicAdd(queues[word + 2], layers);
    const uint entry = atomicAdd(queues[word + 3], 1u);
    atomicAdd(queues[leftBlockWord(entry / VOXTACT_LEFT_BLOCK)], groups);
    quads[quadOf(LEFT_WORD, entry)] = uvec4(what << VOXTACT_LEFT_SHIFT | number, brick, groups, 0);
    return true;
}

#endif
