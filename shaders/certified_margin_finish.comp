// SPDX-License-Identifier: MIT
// The projection `conservative` with a margin, what is left: what the queue of cells or of large triangles had no room
// for, found and decided here. Each entry of that has as many work groups as its bricks need.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define MARGIN
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"
#ifdef CLEARANCE
#include "certified_clearance_cell.glsl"
#endif
#include "certified_shares.glsl"

#ifdef CLEARANCE
ClearanceFound nearest;

/// Says nothing: what it finds is in `nearest`.
int decideCell(uint pair, CertifiedTriangle triangle, ivec3 cell, vec4 range) {
    measureCell(pair, triangle, cell, range, nearest);
    return CERTIFIED_NONE;
}

void tell(uint pair, uint triangle, bool undecided, bool found) {
    nearest.open = undecided ? 0.0 : nearest.open;
    tellFound(pair, triangle, nearest, 0.0);
}
#else
int decideCell(uint pair, CertifiedTriangle triangle, ivec3 cell, vec4 range) {
    const MarginSpace by = MARGIN_SPACE(pair);
    const CertifiedCell known =
        certifiedCell(constants.item, cornersOf(cell, range), cell.x, cell.y, cell.z, triangle.delta);
    if (!marginCellMay(opacities(), known)) {
        return CERTIFIED_NONE;
    }
    const int look =
        marginCellLook(by, constants.item, triangle, marginCellHas(opacities(), known), cell.x, cell.y, cell.z);
    if (look != CERTIFIED_UNDECIDED) {
        return look;
    }
    return marginDecide(opacities(), by, triangle, known, voxelPoint(float(cell.x), float(cell.y), float(cell.z)));
}

void tell(uint pair, uint triangle, bool undecided, bool found) {
    if (isCut()) {
        markUndecided(pair);
    } else if (found) {
        markWithin(pair);
    } else if (undecided) {
        markUndecided(pair);
    }
}
#endif

void decideShare(Share given) {
    Share share = given;
    const TriangleVertices at = verticesOf(transforms[share.pair], share.number);
    const CertifiedBounds bounds = boundsOf(share.pair, at);
    const CellBox cells = cellsOf(bounds);
    if (isEmpty(cells)) {
        return;
    }
    if (!bounds.usable) {
        // All of it: each lane has bricks of its own.
        share.firstBrick = int(gl_LocalInvocationIndex);
        share.stride = VOXTACT_COMPUTE_GROUP;
        share.bricks = 0x7fffffff;
        share.skip = 0;
    }
    const CertifiedTriangle triangle = triangleOf(at, bounds.delta);
    const CellBox box = bricksOf(cells);
    const int count = volumeOf(box);
    uint bricksSeen = 0;
    uint cellsSeen = 0;
    bool undecided = false;
    bool found = false;
#ifdef CLEARANCE
    nearest = nothingFound();
#endif
    int i = share.firstBrick;
    for (int turn = 0; turn < share.bricks && i < count && !found; ++turn) {
        const ivec3 brick = share.single ? share.cell : placeIn(box, i);
        i += share.stride + ((i & 63) == 63 ? share.skip : 0);
        ++bricksSeen;
        const vec4 range = brickAt(brick);
        if (!bounds.usable && nodeMay(numberOf(brick))) {
            undecided = true;
            break;
        }
        if (!bounds.usable || !marginBrickMay(share.pair, triangle, brick)) {
            continue;
        }
        const CellBox inside = within(cells, brick);
        const int most = isEmpty(inside) ? 0 : volumeOf(inside);
        for (int place = share.first; place < most && !found; place += share.step) {
            ++cellsSeen;
            const int verdict = decideCell(share.pair, triangle, placeIn(inside, place), range);
            undecided = undecided || verdict == CERTIFIED_UNDECIDED;
            found = verdict == CERTIFIED_CERTAIN;
        }
    }
    // All lanes look at the same bricks.
    countWork(VOXTACT_WORK_BRICKS_LEFT, bounds.usable && gl_LocalInvocationIndex > 0 ? 0 : bricksSeen);
    countWork(VOXTACT_WORK_CELLS_LEFT, cellsSeen);
    tell(share.pair, share.number, undecided, found);
}

void main() {
    const uint group = groupLeft();
    if (group >= queues[constants.headerWord + VOXTACT_GROUPS_LEFT]) {
        return;
    }
    const Share share = shareOfGroup(group);
    if (share.some && !isDone(share.pair)) {
        decideShare(share);
    }
}
