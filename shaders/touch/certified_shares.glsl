// SPDX-License-Identifier: MIT
// What a work group of certified_finish has of what is left, and what a lane has of that. Expects certified_scene.glsl.
#ifndef VOXTACT_CERTIFIED_SHARES_GLSL
#define VOXTACT_CERTIFIED_SHARES_GLSL

/// The bricks and cells of a triangle that a lane decides.
struct Share {
    bool some;
    uint pair;
    uint number; // of the triangle
    bool single; // a single cell that was left undecided
    ivec3 cell;
    bool large;     // true: the triangle must be large; false: it must be small, except for a single cell
    int firstBrick; // of the triangle's
    int bricks;     // at most
    int stride;     // to the next brick
    int skip;       // bricks after every 64th
    int first;      // of each brick's cells
    int step;
};

shared uint groupsOfLane[VOXTACT_COMPUTE_GROUP];

const Share kNoShare = Share(false, 0, 0, false, ivec3(0), false, 0, 0, 1, 0, 0, 1);

/// The lane that owns a work group, and the work group's number among its own. `groupsOfLane`: work groups of each
/// lane.
struct LaneTurn {
    uint lane; // VOXTACT_COMPUTE_GROUP: none
    uint turn;
};

/// Returns the owner of work group `turn`. All lanes call it together, after writing their numbers.
LaneTurn laneOfTurn(uint turn) {
    barrier();
    LaneTurn found = LaneTurn(0, turn);
    while (found.lane < VOXTACT_COMPUTE_GROUP && found.turn >= groupsOfLane[found.lane]) {
        found.turn -= groupsOfLane[found.lane];
        ++found.lane;
    }
    barrier(); // they are written again
    return found;
}

/// Returns the bricks of work group `turn`, from `brick` on, of a large triangle or of its part with every skip + 1st
/// block of 64.
Share shareOfLarge(uint pair, uint triangle, uint brick, uint skip, uint turn) {
    const uint place = brick % VOXTACT_COMPUTE_GROUP + turn * kBricksOfGroup;
    const uint block = brick / VOXTACT_COMPUTE_GROUP + place / VOXTACT_COMPUTE_GROUP * (skip + 1);
    const uint first = block * VOXTACT_COMPUTE_GROUP + place % VOXTACT_COMPUTE_GROUP;
    return Share(true, pair, triangle, false, ivec3(0), true, int(first), int(kBricksOfGroup), 1,
                 int(skip * VOXTACT_COMPUTE_GROUP), int(gl_LocalInvocationIndex), VOXTACT_COMPUTE_GROUP);
}

/// Returns the large triangle of a work group of certified_expand that owns work group `turn`.
Share shareOfTriangles(uint group, uint turn) {
    const uint lane = gl_LocalInvocationIndex;
    const TriangleLane own = triangleLane(group, lane);
    groupsOfLane[lane] = 0;
    if (own.some) {
        const CertifiedBounds bounds = boundsOf(verticesOf(transforms[own.pair], own.number));
        const CellBox cells = cellsOf(bounds);
        if (!isEmpty(cells) && (isLarge(cells) || !bounds.usable)) {
            groupsOfLane[lane] = groupsOfTriangle(transforms[own.pair], bounds, cells);
        }
    }
    const LaneTurn has = laneOfTurn(turn);
    if (has.lane == VOXTACT_COMPUTE_GROUP) {
        return kNoShare;
    }
    const TriangleLane found = triangleLane(group, has.lane);
    return shareOfLarge(found.pair, found.number, 0, 0, has.turn);
}

/// An overflow entry, and the number of this work group in it.
struct LeftTurn {
    bool some;
    uvec4 entry;
    uint turn;
};

/// Returns the entry that owns work group `group`. All lanes call it together with equal arguments.
LeftTurn entryOfGroup(uint group) {
    const uint lane = gl_LocalInvocationIndex;
    const uint entries = queueCount(VOXTACT_QUEUE_LEFT);
    // The lanes have some blocks each, then an entry each of one block.
    const uint blocks = (entries + VOXTACT_LEFT_BLOCK - 1) / VOXTACT_LEFT_BLOCK;
    const uint blocksOfLane = (blocks + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP;
    uint sum = 0;
    for (uint i = lane * blocksOfLane; i < min((lane + 1) * blocksOfLane, blocks); ++i) {
        sum += queues[leftBlockWord(i)];
    }
    groupsOfLane[lane] = sum;
    LaneTurn has = laneOfTurn(group);
    if (has.lane == VOXTACT_COMPUTE_GROUP) {
        return LeftTurn(false, uvec4(0), 0);
    }
    uint block = has.lane * blocksOfLane;
    while (has.turn >= queues[leftBlockWord(block)]) {
        has.turn -= queues[leftBlockWord(block)];
        ++block;
    }
    const uint first = block * VOXTACT_LEFT_BLOCK;
    groupsOfLane[lane] = first + lane < entries ? quads[quadOf(LEFT_WORD, first + lane)].z : 0;
    has = laneOfTurn(has.turn);
    return LeftTurn(true, quads[quadOf(LEFT_WORD, first + has.lane)], has.turn);
}

/// Returns the number of this work group among those for overflow.
uint groupLeft() {
    return gl_WorkGroupID.x + gl_NumWorkGroups.x * (gl_WorkGroupID.y + gl_NumWorkGroups.y * gl_WorkGroupID.z);
}

/// Returns the overflow share of a work group. All lanes call it together.
Share shareOfGroup(uint group) {
    const uint lane = gl_LocalInvocationIndex;
    const LeftTurn left = entryOfGroup(group);
    if (!left.some) {
        return kNoShare;
    }
    const uvec4 entry = left.entry;
    const uint turn = left.turn;
    const uint what = entry.x >> VOXTACT_LEFT_SHIFT;
    const uint number = entry.x & ((1u << VOXTACT_LEFT_SHIFT) - 1);
    if (what == VOXTACT_LEFT_SMALL) {
        const TriangleLane own = triangleLane(number, lane);
        return Share(own.some, own.pair, own.number, false, ivec3(0), false, 0, VOXTACT_CELLS_OF_A_LANE, 1, 0,
                     int(turn), int(kSharesOfSmall));
    }
    if (what == VOXTACT_LEFT_GROUP) {
        return shareOfTriangles(number, turn);
    }
    const uvec4 part = quads[quadOf(LARGE_WORD, number)];
    return shareOfLarge(part.x, part.y, entry.y, part.w - 1, turn);
}

#endif
