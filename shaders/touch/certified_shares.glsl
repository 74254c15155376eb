// SPDX-License-Identifier: MIT
// What a work group of certified_finish has of what is left, and what a lane has of that. Expects certified_scene.glsl.
#ifndef VOXTACT_CERTIFIED_SHARES_GLSL
#define VOXTACT_CERTIFIED_SHARES_GLSL

/// Which of a triangle's bricks and cells a lane decides.
struct Share {
    bool some;
    uint pair;
    uint number; // of the triangle
    bool single; // one cell, that was left undecided
    ivec3 cell;
    bool large;     // the triangle must be; else it must not, unless it is a single cell
    int firstBrick; // of the triangle's
    int bricks;     // at most
    int stride;     // to the next brick
    int skip;       // bricks after every 64th
    int first;      // of each brick's cells
    int step;
};

shared uint groupsOfLane[VOXTACT_COMPUTE_GROUP];

const Share kNoShare = Share(false, 0, 0, false, ivec3(0), false, 0, 0, 1, 0, 0, 1);

/// Which lane has a work group, of which `groupsOfLane` says how many each has: and which of its own that is.
struct LaneTurn {
    uint lane; // VOXTACT_COMPUTE_GROUP: none
    uint turn;
};

/// The `turn`th of all. Asked by all lanes together, which have written theirs.
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

/// The bricks of a large triangle, or of its part that has every skip + 1st block of 64, that are the `turn`th of those
/// from `brick` on which a work group has.
Share shareOfLarge(uint pair, uint triangle, uint brick, uint skip, uint turn) {
    const uint place = brick % VOXTACT_COMPUTE_GROUP + turn * kBricksOfGroup;
    const uint block = brick / VOXTACT_COMPUTE_GROUP + place / VOXTACT_COMPUTE_GROUP * (skip + 1);
    const uint first = block * VOXTACT_COMPUTE_GROUP + place % VOXTACT_COMPUTE_GROUP;
    return Share(true, pair, triangle, false, ivec3(0), true, int(first), int(kBricksOfGroup), 1,
                 int(skip * VOXTACT_COMPUTE_GROUP), int(gl_LocalInvocationIndex), VOXTACT_COMPUTE_GROUP);
}

/// Of the large triangles of a work group of certified_expand: the one that has the `turn`th of their work groups here.
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

/// An entry of what is left, and which of its work groups this is.
struct LeftTurn {
    bool some;
    uvec4 entry;
    uint turn;
};

/// The entry that has the `group`th work group of all. Asked by all lanes together, of what is the same for all.
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

/// The number of this work group among those for what is left.
uint groupLeft() {
    return gl_WorkGroupID.x + gl_NumWorkGroups.x * (gl_WorkGroupID.y + gl_NumWorkGroups.y * gl_WorkGroupID.z);
}

/// What a work group has of what is left. Asked by all lanes together.
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
