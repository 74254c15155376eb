// SPDX-License-Identifier: MIT
// The projection `conservative`, what is left: cells that single precision leaves undecided, decided again with more of
// it, a lane each; and, in a dispatch of its own, what the queue of cells or of large triangles had no room for, found
// and decided here. Each entry of that has as many work groups as its bricks need.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#ifdef OUTPUTS
#extension GL_EXT_samplerless_texture_functions : require
#endif
#extension GL_EXT_control_flow_attributes : require
#define SMALL_PROGRAM
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

/// A triangle, as the first passes and as this one places it.
struct Placed {
    uint pair;
    uint number;
    CertifiedTriangle rounded;
    bool usable; // `rounded` is
    bool again;  // what is decided with it was left undecided
    PreciseTriangle precisely;
};

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

shared uvec4 entryOfGroup; // of the queue of what is left
shared uint groupsOfLane[VOXTACT_COMPUTE_GROUP];

uint survivors = 0;
bool undecided = false;

/// The attempts at a cell: as the first pass; precisely; the part of it that is certainly in the domain.
void decideCell(Placed triangle, ivec3 cell, vec4 range) {
    const CertifiedCorners corners = cornersOf(cell, range);
    CertifiedCell known = certifiedCell(constants.item, corners, cell.x, cell.y, cell.z, triangle.rounded.delta);
    if (!certifiedCellMayBeOpaque(opacities(), known)) {
        return;
    }
    int verdict = CERTIFIED_UNDECIDED;
    int attempt = triangle.usable && !triangle.again ? -1 : 0;
    CertifiedWitness witness;
    while (verdict == CERTIFIED_UNDECIDED && attempt < 2) {
        ++attempt;
        VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
        int count;
        if (attempt == 0) {
            count = certifiedBegin(opacities(), triangle.rounded, known, cell.x, cell.y, cell.z, polygon);
        } else {
            if (attempt == 1) {
                known = preciseCell(constants.item, triangle.precisely, corners, cell.x, cell.y, cell.z);
            } else if (preciseCrosses(known)) {
                known = preciseWithin(known);
            } else {
                break;
            }
            count = certifiedBeginAgain(triangle.precisely, known, cell.x, cell.y, cell.z, attempt == 2, polygon);
        }
        const float resolution = attempt == 0 ? constants.item.resolution : certifiedFinest(constants.item);
        verdict = certifiedSettle(opacities(), resolution, known, polygon, count, witness);
        // What is certainly in the domain has no opaque point, but there is more.
        verdict = attempt == 2 && verdict == CERTIFIED_NONE ? CERTIFIED_UNDECIDED : verdict;
    }
    if (verdict == CERTIFIED_UNDECIDED) {
        undecided = true;
    }
    if (verdict == CERTIFIED_CERTAIN && !isCut()) {
        ++survivors;
#ifdef OUTPUTS
        emitWitness(triangle.pair, triangle.number, corners, witness, cell);
#endif
    }
}

bool planeMisses(Placed triangle, PrecisePlane plane, vec3 centre, float radius) {
    const VoxelPoint at = voxelPoint(centre.x, centre.y, centre.z);
    return triangle.usable ? certifiedPlaneMisses(triangle.rounded, at, radius) : precisePlaneMisses(plane, at, radius);
}

void decideShare(Share given) {
    Share share = given;
    const CertifiedPair transform = transforms[share.pair];
    const TriangleVertices at = verticesOf(transform, share.number);
    const CertifiedBounds bounds = boundsOf(at);
    const CellBox cells = share.single ? CellBox(share.cell, share.cell) : cellsOf(bounds);
    if (isEmpty(cells) || (!share.single && share.large != (isLarge(cells) || !bounds.usable))) {
        return;
    }
    if (share.large && isLost(transform, bounds)) {
        // All of it: each lane has bricks of its own.
        share.firstBrick = int(gl_LocalInvocationIndex);
        share.stride = VOXTACT_COMPUTE_GROUP;
        share.bricks = 0x7fffffff;
        share.skip = 0;
        share.first = 0;
        share.step = 1;
    }
    const Placed triangle =
        Placed(share.pair, share.number, triangleOf(at, bounds.delta), bounds.usable, share.single,
               preciseTriangle(transform, constants.item, at.object[0], at.object[1], at.object[2]));
    const PrecisePlane plane = precisePlane(constants.item, triangle.precisely);
    const bool isKnown = triangle.usable || preciseKnown(triangle.precisely);
    const CellBox box = bricksOf(cells);
    const bool single = cells.lo == cells.hi;
    const int count = volumeOf(box);
    const bool byOthers = share.large && gl_LocalInvocationIndex > 0; // all lanes look at the same bricks
    uint bricksSeen = 0;
    uint cellsSeen = 0;
    int i = share.firstBrick;
    for (int turn = 0; turn < share.bricks && i < count; ++turn) {
        const ivec3 brick = placeIn(box, i);
        i += share.stride + ((i & 63) == 63 ? share.skip : 0);
        const vec4 range = brickAt(brick);
        ++bricksSeen;
        if (!brickMayBeOpaque(range)) {
            continue;
        }
        if (!isKnown) {
            undecided = true;
            break;
        }
        if (count > 1 && planeMisses(triangle, plane, brickCentre(brick), float(kBrickSide / 2))) {
            continue;
        }
        const CellBox inside = within(cells, brick);
        const int most = volumeOf(inside);
        for (int place = share.first; place < most; place += share.step) {
            ++cellsSeen;
            const ivec3 cell = placeIn(inside, place);
            if (single || !planeMisses(triangle, plane, vec3(cell) + 0.5, 0.5)) {
                decideCell(triangle, cell, range);
            }
        }
    }
    if (!share.single) {
        countWork(VOXTACT_WORK_BRICKS_LEFT, byOthers && share.stride == 1 ? 0 : bricksSeen);
        countWork(VOXTACT_WORK_CELLS_LEFT, cellsSeen);
    }
}

const Share kNoShare = Share(false, 0, 0, false, ivec3(0), false, 0, 0, 1, 0, 0, 1);

/// A cell that was left undecided.
Share shareOfCell(uint number) {
    if (number >= queueCount(VOXTACT_QUEUE_OPEN)) {
        return kNoShare;
    }
    const uint open = queues[constants.queueWord + VOXTACT_WORD_OPEN(constants.queueRoom) + number];
    const uvec4 entry = quads[quadOf(VOXTACT_WORD_CELLS, open)];
    return Share(true, entry.x, entry.y, true, unpackCell(entry.zw), false, 0, 1, 1, 0, 0, 1);
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
    barrier();
    uint before = 0;
    uint of = 0;
    while (of < VOXTACT_COMPUTE_GROUP && turn - before >= groupsOfLane[of]) {
        before += groupsOfLane[of];
        ++of;
    }
    if (of == VOXTACT_COMPUTE_GROUP) {
        return kNoShare;
    }
    const TriangleLane found = triangleLane(group, of);
    return shareOfLarge(found.pair, found.number, 0, 0, turn - before);
}

/// What a work group has of what is left. Asked by all lanes together.
Share shareOfGroup(uint group) {
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0) {
        entryOfGroup = uvec4(0);
    }
    barrier();
    const uint entries = queueCount(VOXTACT_QUEUE_LEFT);
    for (uint i = lane; i < entries; i += VOXTACT_COMPUTE_GROUP) {
        const uvec4 entry = quads[quadOf(VOXTACT_WORD_LEFT(constants.queueRoom), i)];
        if (group - entry.w < entry.z) {
            entryOfGroup = entry;
        }
    }
    barrier();
    const uvec4 entry = entryOfGroup;
    barrier();
    if (entry.z == 0) {
        return kNoShare;
    }
    const uint what = entry.x >> VOXTACT_LEFT_SHIFT;
    const uint number = entry.x & ((1u << VOXTACT_LEFT_SHIFT) - 1);
    const uint turn = group - entry.w;
    if (what == VOXTACT_LEFT_SMALL) {
        const TriangleLane own = triangleLane(number, lane);
        return Share(own.some, own.pair, own.number, false, ivec3(0), false, 0, VOXTACT_CELLS_OF_A_LANE, 1, 0,
                     int(turn), int(kSharesOfSmall));
    }
    if (what == VOXTACT_LEFT_GROUP) {
        return shareOfTriangles(number, turn);
    }
    const uvec4 part = quads[quadOf(VOXTACT_WORD_LARGE(constants.queueRoom), number)];
    return shareOfLarge(part.x, part.y, entry.y, part.w - 1, turn);
}

void main() {
    const bool ofCells = gl_NumWorkGroups.y != VOXTACT_LEFT_ROWS;
    const uint layer = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    const uint groups = ofCells ? gl_WorkGroupID.x + 1 : queues[constants.headerWord + VOXTACT_GROUPS_LEFT];
    // One turn, unless the device has not as many work groups.
    for (uint group = gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y + layer * gl_WorkGroupID.z;
         group < groups; group += layer * gl_NumWorkGroups.z) {
        Share share;
        if (ofCells) {
            share = shareOfCell(gl_GlobalInvocationID.x);
        } else {
            share = shareOfGroup(group);
        }
        survivors = 0;
        undecided = false;
        if (share.some && !isDone(share.pair)) {
            decideShare(share);
            if (survivors > 0) {
                addSurvivors(share.pair, survivors);
            }
            if (undecided || isCut()) {
                atomicOr(results[share.pair].how, VOXTACT_HOW_UNDECIDED_BIT);
            }
        }
    }
}
