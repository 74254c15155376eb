// SPDX-License-Identifier: MIT
// The queues between the passes of the projection `certified`: shared.h says where they lie. A work group puts all
// that it has into a queue at once, with one atomic for the place and one for the work groups of the pass that empties
// it. Expects `constants`, `kCounters` and brickCounts().
#ifndef VOXTACT_CERTIFIED_QUEUES_GLSL
#define VOXTACT_CERTIFIED_QUEUES_GLSL

// After the transforms, in the same buffer.
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) buffer Queues { uint queues[]; };
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) buffer Quads { uvec4 quads[]; };

#define LARGE_WORD VOXTACT_WORD_LARGE(constants.queueRoom)
#define LARGE_ROOM VOXTACT_ROOM_LARGE(constants.queueRoom)
#define LEFT_WORD VOXTACT_WORD_LEFT(constants.queueRoom)
#define LEFT_ROOM VOXTACT_ROOM_LEFT(constants.queueRoom)

uint queueCount(uint queue) {
    return queues[constants.headerWord + 4 * queue + 3];
}

/// Adds to a VOXTACT_WORK_* counter of the round, if counters are enabled.
void countWork(uint word, uint work) {
    if (kCounters && work > 0) {
        atomicAdd(queues[constants.headerWord + word], work);
    }
}

/// Reserves `entries` of a queue as far as it has room, and work groups of `lanes` entries for the pass that empties
/// it. Returns the number of the first entry; entries from `room` on do not exist.
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

/// Returns the index in `quads` of entry `entry` of a queue of four words.
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

/// Bricks of a large triangle per work group of certified_finish, and shares of the cells of small triangles. They
/// limit a lane to some tens of cells, however large the triangles are.
const uint kBricksOfGroup = 8;
const uint kSharesOfSmall = 3;

uint groupsOfBricks(uint bricks) {
    return (bricks + kBricksOfGroup - 1) / kBricksOfGroup;
}

/// Maximum cell tests of a work group of certified_finish.
const uint kLooksOfGroup = kBricksOfGroup << (3 * VOXTACT_BRICK_SHIFT);

/// Maximum work groups of certified_finish in a round; more are refused.
uint mostGroupsLeft() {
    // The host bounds the number of tests; boxes of large triangles have dozens of times as many bricks as the
    // triangles cross. The host cannot bound triangles that it does not know, nor split a cluster, which may overflow
    // as a whole and in parts.
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

/// Clears one lane's share, of `lanes`, of the overflow blocks: for the first pass of a round.
void emptyLeftBlocks(uint lane, uint lanes) {
    for (uint block = lane; block * VOXTACT_LEFT_BLOCK < LEFT_ROOM; block += lanes) {
        queues[leftBlockWord(block)] = 0;
    }
}

/// Adds an entry of certified_finish that needs `groups` work groups. Returns false if it is refused: its pairs are
/// then undecided.
bool leave(uint what, uint number, uint brick, uint groups) {
    const uint word = constants.headerWord + 4 * VOXTACT_QUEUE_LEFT;
    // Never exceeds the maximum, not even for a moment: the sum of all refused entries may overflow a word.
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
