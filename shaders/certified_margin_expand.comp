// SPDX-License-Identifier: MIT
// The projection `conservative` with a margin, the bricks near triangles: a work group has four runs, a lane each
// triangle. A run's lanes share the bricks near its box; those that may have something opaque within the margin of it go
// into the queue of large triangles, one an entry. Where the triangles of a run are far from each other, each looks for
// bricks of its own. Of a run with a long triangle, which passes through few of the bricks of its box, the lanes share
// blocks of bricks, and look at each triangle. A triangle that is near more than a lane looks at is left to
// certified_margin_finish. What is put twice does no harm: the answer is yes where one says so.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define MARGIN
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"
#ifdef CLEARANCE
#include "certified_clearance_bits.glsl"
#endif

/// Bricks that a run looks at, and a triangle by itself.
#ifdef CLEARANCE
const int kMostBricks = 32768;
const int kMostBricksOfTriangle = 2048;
#else
const int kMostBricks = 512;
const int kMostBricksOfTriangle = 512;
#endif

/// Voxels: a triangle with a longer side is long.
const float kLongSide = 64.0;
/// Bricks of a block, and those of all blocks that the lanes of a run look at.
const int kBricksOfBlock = 64;
const int kMostInBlocks = 65536;

const uint kRefused = 2; // beside that the queue is full

shared uint groupsIfLeft; // of certified_margin_finish, for all of the work group
shared uint full;         // the queue is
// Of the lane's triangle, where the run is to look at it.
shared CertifiedReach reaches[VOXTACT_COMPUTE_GROUP];
shared float ownCells[VOXTACT_COMPUTE_GROUP]; // of its box; 0: the run is not to
shared CertifiedTriangle triangles[VOXTACT_COMPUTE_GROUP];
shared uint longRuns; // a bit for each run of the work group that has a long triangle

/// Bricks that are too many for a lane; also where their number overflows.
bool areMoreThan(int most, CellBox bricks) {
    const ivec3 sides = bricks.hi - bricks.lo + 1;
    return any(greaterThan(sides, ivec3(most))) || volumeOf(bricks) > most;
}

/// As large as it may be, and never negative.
float cellsIn(CellBox cells) {
    const vec3 sides = vec3(max(cells.hi - cells.lo + 1, 0));
    return sides.x * sides.y * sides.z;
}

void putLarge(uint pair, uint number, uint brick, uint which) {
#ifdef CLEARANCE
    const uint entry = reserve(VOXTACT_QUEUE_LARGE, 1, LARGE_ROOM, VOXTACT_COMPUTE_GROUP);
    brick = which == VOXTACT_MARGIN_ALL ? brick : wantBits(brick);
#else
    const uint entry = reserve(VOXTACT_QUEUE_LARGE, 1, LARGE_ROOM, 1);
#endif
    if (entry < LARGE_ROOM) {
        quads[quadOf(LARGE_WORD, entry)] = uvec4(pair, number, brick, which);
    } else {
        atomicOr(full, 1u);
    }
}

/// The lane's triangle, by itself.
void putBricksOfTriangle(TriangleLane own, CertifiedTriangle triangle, CellBox near) {
    const int count = volumeOf(near);
    countWork(VOXTACT_WORK_BRICKS, uint(count));
    for (int i = 0; i < count; ++i) {
        const ivec3 brick = placeIn(near, i);
        if (marginBrickMay(own.pair, triangle, brick)) {
            putLarge(own.pair, own.run, uint(numberOf(brick)), 1u << gl_LocalInvocationIndex % VOXTACT_RUN_TRIANGLES);
        }
    }
}

/// The lane's share of the bricks near its run.
void putBricksOfRun(TriangleLane own, CertifiedReach reach, CellBox near, uint which) {
    const MarginSpace by = MARGIN_SPACE(own.pair);
    const int count = volumeOf(near);
    uint seen = 0;
    for (int i = int(gl_LocalInvocationIndex % VOXTACT_RUN_TRIANGLES); i < count; i += VOXTACT_RUN_TRIANGLES) {
        const ivec3 brick = placeIn(near, i);
        const vec3 middle = brickCentre(brick);
        const float radius = float(kBrickSide / 2);
        ++seen;
        if (nodeMay(numberOf(brick)) &&
            !marginReachFarther(by, reach, voxelPoint(middle.x, middle.y, middle.z),
                                voxelPoint(radius, radius, radius))) {
            // What is next tells which are near.
            putLarge(own.pair, own.run, uint(numberOf(brick)), which);
        }
    }
    countWork(VOXTACT_WORK_BRICKS, seen);
}

/// Those of some triangles of the lane's run that something in a box of bricks may be within the margin of.
uint nearOf(TriangleLane own, uint which, CellBox bricks) {
    const uint first = gl_LocalInvocationIndex / VOXTACT_RUN_TRIANGLES * VOXTACT_RUN_TRIANGLES;
    uint found = 0;
    for (uint left = which; left != 0; left &= left - 1) {
        const int i = findLSB(left);
        if (!marginBoxFarther(MARGIN_SPACE(own.pair), triangles[first + i], middleOf(bricks), radiusOf(bricks))) {
            found |= 1u << i;
        }
    }
    return found;
}

/// The lane's share of the bricks near a run with a long triangle.
void putBricksOfLongRun(TriangleLane own, CellBox near, uint which) {
    const int count = volumeOf(near);
    const int lane = int(gl_LocalInvocationIndex % VOXTACT_RUN_TRIANGLES);
    uint seen = 0;
    for (int block = lane * kBricksOfBlock; block < count; block += VOXTACT_RUN_TRIANGLES * kBricksOfBlock) {
        const int end = min(block + kBricksOfBlock, count);
        const uint some = nearOf(own, which, bricksFrom(near, block, end - 1));
        for (int i = some != 0 ? block : end; i < end; ++i) {
            const ivec3 brick = placeIn(near, i);
            const uint here = nodeMay(numberOf(brick)) ? nearOf(own, some, CellBox(brick, brick)) : 0;
            ++seen;
            if (here != 0) {
                putLarge(own.pair, own.run, uint(numberOf(brick)), here);
            }
        }
    }
    countWork(VOXTACT_WORK_BRICKS, seen);
}

/// What a run's triangles say together: of those that it is to look at.
struct Together {
    CertifiedReach reach;
    CellBox cells;
    uint which; // a bit each
    bool near;  // to each other: their box has no more cells than their own boxes have together
};

Together togetherOf(TriangleLane own) {
    const uint run = gl_LocalInvocationIndex / VOXTACT_RUN_TRIANGLES;
    const float far = CERTIFIED_FARTHEST;
    Together found;
    found.reach = CertifiedReach(voxelPoint(far, far, far), voxelPoint(-far, -far, -far), 0.0);
    found.which = 0;
    float cells = 0.0;
    for (uint i = 0; i < VOXTACT_RUN_TRIANGLES; ++i) {
        const uint lane = run * VOXTACT_RUN_TRIANGLES + i;
        if (ownCells[lane] > 0.0) {
            found.reach = marginUnion(found.reach, reaches[lane]);
            found.which |= 1u << i;
            cells += ownCells[lane];
        }
    }
    found.cells = cellsOf(marginBounds(constants.item, MARGIN_SPACE(own.pair), found.reach));
    found.near = cellsIn(found.cells) <= cells && !areMoreThan(kMostBricks, bricksOf(found.cells));
    return found;
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0) {
        groupsIfLeft = 0;
        full = 0;
        longRuns = 0;
    }
    ownCells[lane] = 0.0;
    barrier();
    const TriangleLane own = triangleLane(gl_WorkGroupID.x, lane);
    TriangleVertices at;
    CertifiedBounds bounds;
    if (own.some) {
        at = verticesOf(transforms[own.pair], own.number);
        bounds = boundsOf(own.pair, at);
        const CellBox cells = cellsOf(bounds);
        if (!isEmpty(cells)) {
            // Those of pairs that are done, too: certified_margin_finish must find the same, and more will be done then.
            atomicAdd(groupsIfLeft, groupsOfTriangle(transforms[own.pair], bounds, cells));
            if (isDone(own.pair)) {
#ifdef CLEARANCE
            } else if (!bounds.usable) {
                leaveOpen(own.pair, mayHaveAnything() ? 0.0 : VOXTACT_CLEARANCE_FAR);
#endif
            } else if (!bounds.usable) {
                putLarge(own.pair, own.number, 0, VOXTACT_MARGIN_ALL);
            } else {
                reaches[lane] = certifiedReach(at.voxel[0], at.voxel[1], at.voxel[2]);
                ownCells[lane] = cellsIn(cells);
                triangles[lane] = triangleOf(at, bounds.delta);
                if (triangles[lane].reach > kLongSide) {
                    atomicOr(longRuns, 1u << lane / VOXTACT_RUN_TRIANGLES);
                }
            }
        }
    }
    barrier();
    const Together run = togetherOf(own);
    const bool isLong = (longRuns >> lane / VOXTACT_RUN_TRIANGLES & 1u) != 0;
    if (run.which != 0 && isLong && !areMoreThan(kMostInBlocks, bricksOf(run.cells))) {
        putBricksOfLongRun(own, bricksOf(run.cells), run.which);
    } else if (run.which != 0 && run.near) {
        putBricksOfRun(own, run.reach, bricksOf(run.cells), run.which);
    } else if (ownCells[lane] > 0.0 && areMoreThan(kMostBricksOfTriangle, bricksOf(cellsOf(bounds)))) {
        putLarge(own.pair, own.number, 0, VOXTACT_MARGIN_ALL);
    } else if (ownCells[lane] > 0.0) {
        putBricksOfTriangle(own, triangles[lane], bricksOf(cellsOf(bounds)));
    }
    if (isCut()) {
        atomicOr(full, 1u); // a lane has many bricks; what was put is decided twice
    }
    barrier();
#ifdef CLEARANCE
    if (full != 0 && own.some && mayLookLessFar(own.pair)) {
        atomicOr(full, kRefused); // for all of the work group
    }
    barrier();
#endif
    if (lane == 0 && full == 1 && !leave(VOXTACT_LEFT_GROUP, gl_WorkGroupID.x, 0, groupsIfLeft)) {
        atomicOr(full, kRefused);
    }
    barrier();
    if (full >= kRefused && own.some && !isEmpty(cellsOf(bounds))) {
#ifdef CLEARANCE
        refuse(own.pair);
#else
        markUndecided(own.pair);
#endif
    }
}
