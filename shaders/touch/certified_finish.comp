// SPDX-License-Identifier: MIT
// The projection `certified`, what is left: cells that single precision leaves undecided, decided again with more of
// it, a lane each; and, in a dispatch of its own, what the queue of cells or of large triangles had no room for, found
// and decided here. Each entry of that has as many work groups as its bricks need.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef OUTPUTS
#extension GL_EXT_samplerless_texture_functions : require
#endif
#extension GL_EXT_control_flow_attributes : require
#define SMALL_PROGRAM
#include "exact/shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"
#include "certified_shares.glsl"

/// A triangle, placed as by the first passes, and precisely.
struct Placed {
    uint pair;
    uint number;
    CertifiedTriangle rounded;
    bool usable; // `rounded` is usable
    bool again;  // its cell was left undecided
    PreciseTriangle precisely;
};

uint survivors = 0;
bool undecided = false;

#include "exact/exact_language.h"

/// Attempts at a cell: like the first pass; precisely; with the range of its own voxels; only the part that is
/// certainly in the domain.
void decideCell(Placed triangle, ivec3 cell, vec4 range) {
    CertifiedCorners corners = cornersOf(cell, range);
    CertifiedCell known = certifiedCell(constants.item, corners, cell.x, cell.y, cell.z, triangle.rounded.delta);
    if (!certifiedCellMayBeOpaque(opacities(), known)) {
        return;
    }
    int verdict = CERTIFIED_UNDECIDED;
    int attempt = triangle.usable && !triangle.again ? -1 : 0;
    CertifiedWitness witness;
    while (verdict == CERTIFIED_UNDECIDED && attempt < 3) {
        ++attempt;
        int count;
        if (attempt == 0) {
            count = certifiedBegin(opacities(), triangle.rounded, known, cell.x, cell.y, cell.z);
        } else {
            if (attempt < 3) {
                if (attempt == 2) {
                    corners = cornersAround(corners, cell);
                }
                known = preciseCell(constants.item, triangle.precisely, corners, cell.x, cell.y, cell.z);
            } else if (preciseCrosses(known)) {
                known = preciseWithin(known);
            } else {
                break;
            }
            count = certifiedBeginAgain(triangle.precisely, known, cell.x, cell.y, cell.z, attempt == 3);
        }
        const float resolution = attempt == 0 ? constants.item.resolution : certifiedFinest(constants.item);
        verdict = certifiedSettle(opacities(), resolution, known, count, witness);
        // The part that is certainly in the domain has no opaque point; the rest is open.
        verdict = attempt == 3 && verdict == CERTIFIED_NONE ? CERTIFIED_UNDECIDED : verdict;
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

bool misses(Placed triangle, PrecisePlane plane, vec3 centre, float radius) {
    const VoxelPoint at = voxelPoint(centre.x, centre.y, centre.z);
    if (!triangle.usable) {
        return precisePlaneMisses(plane, at, radius);
    }
    return certifiedPlaneMisses(triangle.rounded, at, radius) || certifiedEdgesMiss(triangle.rounded, at, radius);
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
               preciseTriangle(share.pair, constants.item, at.object[0], at.object[1], at.object[2]));
    const PrecisePlane plane = precisePlane(constants.item, triangle.precisely);
    const bool isKnown = triangle.usable || preciseKnown(triangle.precisely);
    const CellBox box = bricksOf(cells);
    const bool single = cells.lo == cells.hi;
    const int count = volumeOf(box);
    const bool byOthers = share.large && gl_LocalInvocationIndex > 0; // all lanes test the same bricks
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
        if (count > 1 && misses(triangle, plane, brickCentre(brick), float(kBrickSide / 2))) {
            continue;
        }
        const CellBox inside = within(cells, brick);
        const int most = volumeOf(inside);
        for (int place = share.first; place < most; place += share.step) {
            ++cellsSeen;
            const ivec3 cell = placeIn(inside, place);
            if (single || !misses(triangle, plane, vec3(cell) + 0.5, 0.5)) {
                decideCell(triangle, cell, range);
            }
        }
    }
    if (!share.single) {
        countWork(VOXTACT_WORK_BRICKS_LEFT, byOthers && share.stride == 1 ? 0 : bricksSeen);
        countWork(VOXTACT_WORK_CELLS_LEFT, cellsSeen);
    }
}

/// A cell that was left undecided.
Share shareOfCell(uint number) {
    if (number >= queueCount(VOXTACT_QUEUE_OPEN)) {
        return kNoShare;
    }
    const uint open = queues[constants.queueWord + VOXTACT_WORD_OPEN(constants.queueRoom) + number];
    const uvec4 entry = quads[quadOf(VOXTACT_WORD_CELLS, open)];
    return Share(true, entry.x, entry.y, true, unpackCell(entry.zw), false, 0, 1, 1, 0, 0, 1);
}

void main() {
    const bool ofCells = gl_NumWorkGroups.y != VOXTACT_LEFT_ROWS;
    Share share;
    if (ofCells) {
        share = shareOfCell(gl_GlobalInvocationID.x);
    } else {
        const uint group = groupLeft();
        if (group >= queues[constants.headerWord + VOXTACT_GROUPS_LEFT]) {
            return;
        }
        share = shareOfGroup(group);
    }
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
