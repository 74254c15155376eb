// SPDX-License-Identifier: MIT
// The projection `certified`, the cells of triangles: a work group has four runs, a lane each triangle. The cells
// that need a decision go into the queue of cells; a triangle with many is put into the queue of large ones, where work
// groups share it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "exact/shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

#define VOXTACT_CELL_LIST (VOXTACT_COMPUTE_GROUP * VOXTACT_CELLS_OF_A_LANE)
#include "certified_cells.glsl"

/// Data of a lane's triangle, for the lane that queues its cells.
struct LaneCells {
    uint pair;
    uint triangle;
    ivec3 lo;
    ivec3 size;
};
shared LaneCells ofLane[VOXTACT_COMPUTE_GROUP];
shared uint pairOfGroup; // of the first lane, and so of most
shared uint parts;       // of large triangles
shared uint firstPart;
shared uint groupsIfLeft; // of certified_finish, for all large triangles
shared uint refused;      // not 0: some pairs are not examined completely

/// Returns the number of work groups of certified_large for a triangle: one per 32 bricks that it may cross, up to a
/// limit, each with at least one block of bricks. The estimate counts the brick sides that its projections cover and
/// its edges cross.
uint partsOf(CertifiedTriangle triangle, CellBox cells) {
    const float kMostParts = 64.0;
    const float kBricksOfPart = 32.0;
    const float side = float(kBrickSide);
    const VoxelPoint normal = triangle.normal;
    const float shadows = 0.5 * (certifiedAbs(normal.x) + certifiedAbs(normal.y) + certifiedAbs(normal.z));
    const float bricks = shadows / (side * side) + 3.0 * triangle.reach / side;
    const ivec3 size = bricksOf(cells).hi - bricksOf(cells).lo + 1;
    const float blocks = float(size.x) * float(size.y) * float(size.z) / float(VOXTACT_COMPUTE_GROUP);
    return uint(clamp(min(bricks / kBricksOfPart, blocks), 1.0, kMostParts));
}

/// A bit for each brick of a small triangle: it may have fragments with an opaque point.
uint bricksThatMayTouch(CertifiedTriangle triangle, CellBox box) {
    const int count = volumeOf(box);
    uint bits = 0;
    for (int i = 0; i < count; ++i) {
        const ivec3 brick = placeIn(box, i);
        const vec3 centre = brickCentre(brick);
        if (brickMayBeOpaque(brickAt(brick)) &&
            !(count > 1 &&
              certifiedPlaneMisses(triangle, voxelPoint(centre.x, centre.y, centre.z), float(kBrickSide / 2)))) {
            bits |= 1u << i;
        }
    }
    return bits;
}

/// Lists the cells of the lane's small triangle that need a decision. Returns the number of fragments that are certain
/// without one.
uint listCells(CertifiedTriangle triangle, CellBox cells) {
    uint certain = 0;
    const CellBox box = bricksOf(cells);
    const uint bricks = bricksThatMayTouch(triangle, box);
    const ivec3 boxSize = box.hi - box.lo + 1;
    const bool single = cells.lo == cells.hi;
    const int count = bricks == 0 ? 0 : volumeOf(cells);
    countWork(VOXTACT_WORK_CELLS, uint(count));
    for (int i = 0; i < count; ++i) {
        const ivec3 cell = placeIn(cells, i);
        const ivec3 brick = (cell + 1) >> VOXTACT_BRICK_SHIFT;
        const ivec3 inBox = brick - box.lo;
        const uint bit = 1u << (inBox.x + boxSize.x * (inBox.y + boxSize.y * inBox.z));
        if ((bricks & bit) != 0) {
            const int verdict = fragmentVerdict(triangle, cell, brickAt(brick), single, kWitnesses);
            if (verdict == CERTIFIED_UNDECIDED) {
                list[atomicAdd(listed, 1u)] = gl_LocalInvocationIndex << 8 | uint(i);
            }
            certain += verdict == CERTIFIED_CERTAIN ? 1 : 0;
        }
    }
    return certain;
}

void putLarge(TriangleLane own, uint slot, uint count) {
    const uint room = VOXTACT_ROOM_LARGE(constants.queueRoom);
    for (uint part = 0; part < count; ++part) {
        const uint entry = firstPart + slot + part;
        if (entry < room) {
            // If the queue has no room for all cells of the group, it gets none.
            const uint pair = firstPart + parts <= room ? own.pair : kNoPair;
            quads[quadOf(LARGE_WORD, entry)] = uvec4(pair, own.number, part, count);
        }
    }
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0) {
        listed = 0;
        certainOfGroup = 0;
        parts = 0;
        firstPart = 0;
        groupsIfLeft = 0;
        refused = 0;
    }
    barrier();
    const TriangleLane own = triangleLane(gl_WorkGroupID.x, lane);
    uint partsOfLane = 0;
    uint slot = 0;
    uint certain = 0;
    if (lane == 0) {
        pairOfGroup = own.pair;
    }
    if (own.some) {
        const TriangleVertices at = verticesOf(transforms[own.pair], own.number);
        const CertifiedBounds bounds = boundsOf(at);
        const CellBox cells = cellsOf(bounds);
        const bool wanted = !isDone(own.pair);
        if (isEmpty(cells)) {
        } else if (isLarge(cells) || !bounds.usable) {
            // Includes pairs that are done: certified_finish must find the same triangles, and more pairs will be done
            // by then.
            atomicAdd(groupsIfLeft, groupsOfTriangle(transforms[own.pair], bounds, cells));
            if (wanted) {
                partsOfLane = bounds.usable ? partsOf(triangleOf(at, bounds.delta), cells) : 1;
                slot = atomicAdd(parts, partsOfLane);
            }
        } else if (wanted) {
            ofLane[lane] = LaneCells(own.pair, own.number, cells.lo, cells.hi - cells.lo + 1);
            certain = listCells(triangleOf(at, bounds.delta), cells);
        }
    }
    barrier();
    if (lane == 0 && parts > 0) {
        const uint room = VOXTACT_ROOM_LARGE(constants.queueRoom);
        firstPart = reserve(VOXTACT_QUEUE_LARGE, parts, room, 1);
        if (firstPart + parts > room && !leave(VOXTACT_LEFT_GROUP, gl_WorkGroupID.x, 0, groupsIfLeft)) {
            refused = 1;
        }
    }
    const bool fits = reserveList();
    if (!fits && lane == 0 && !leave(VOXTACT_LEFT_SMALL, gl_WorkGroupID.x, 0, kSharesOfSmall)) {
        refused = 1;
    }
    if (fits && certain > 0) { // else certified_finish counts them
        if (own.pair == pairOfGroup) {
            atomicAdd(certainOfGroup, certain);
        } else {
            countWork(VOXTACT_WORK_CERTAIN, certain);
            addSurvivors(own.pair, certain);
        }
    }
    putLarge(own, slot, partsOfLane);
    for (uint i = lane; fits && i < listed; i += VOXTACT_COMPUTE_GROUP) {
        const LaneCells of = ofLane[list[i] >> 8];
        const int number = int(list[i] & 0xffu);
        const int row = number / of.size.x;
        putCell(i, of.pair, of.triangle, of.lo + ivec3(number % of.size.x, row % of.size.y, row / of.size.y));
    }
    barrier();
    if (refused != 0 && own.some) {
        atomicOr(results[own.pair].how, VOXTACT_HOW_UNDECIDED_BIT);
    }
    if (lane == 0 && certainOfGroup > 0) {
        countWork(VOXTACT_WORK_CERTAIN, certainOfGroup);
        addSurvivors(pairOfGroup, certainOfGroup);
    }
}
