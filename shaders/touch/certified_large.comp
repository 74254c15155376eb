// SPDX-License-Identifier: MIT
// The projection `certified`, the cells of large triangles: a work group has a part of one, blocks of as many bricks
// as it has lanes. The lanes share the blocks, then the bricks of each block that may touch, and then their cells.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "exact/shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

// The cells of a brick.
#define VOXTACT_CELL_LIST 512
#include "certified_cells.glsl"

shared uint blocksKept[VOXTACT_COMPUTE_GROUP / 32];
shared uint bricksKept[VOXTACT_COMPUTE_GROUP / 32];

bool misses(CertifiedTriangle triangle, vec3 centre, float radius) {
    const VoxelPoint at = voxelPoint(centre.x, centre.y, centre.z);
    return certifiedPlaneMisses(triangle, at, radius) || certifiedEdgesMiss(triangle, at, radius);
}

/// Queues the cells of a brick that need a decision, and counts cells that are certain without one. Returns false, and
/// counts nothing, if the queue has no room.
bool putBrick(uvec4 entry, CertifiedTriangle triangle, CellBox cells, ivec3 brick) {
    const uint lane = gl_LocalInvocationIndex;
    const CellBox inside = within(cells, brick);
    const vec4 range = brickAt(brick);
    const int most = volumeOf(inside);
    if (lane == 0) {
        listed = 0;
        countWork(VOXTACT_WORK_CELLS, uint(most));
    }
    barrier();
    uint certain = 0;
    for (int i = int(lane); i < most; i += VOXTACT_COMPUTE_GROUP) {
        const ivec3 cell = placeIn(inside, i);
        const int verdict = misses(triangle, vec3(cell) + 0.5, 0.5)
                                ? CERTIFIED_NONE
                                : fragmentVerdict(triangle, cell, range, true, kWitnesses);
        if (verdict == CERTIFIED_UNDECIDED) {
            list[atomicAdd(listed, 1u)] = uint(i);
        }
        certain += verdict == CERTIFIED_CERTAIN ? 1 : 0;
    }
    barrier();
    const bool fits = reserveList();
    if (fits && certain > 0 && !isCut()) {
        atomicAdd(certainOfGroup, certain);
    }
    for (uint i = lane; fits && i < listed; i += VOXTACT_COMPUTE_GROUP) {
        putCell(i, entry.x, entry.y, placeIn(inside, int(list[i])));
    }
    barrier();
    return fits;
}

/// Returns the number of work groups that certified_finish needs for a part from a brick on.
uint groupsFrom(uvec4 entry, uint brick, uint count) {
    const uint blocks = ((count - 1) / VOXTACT_COMPUTE_GROUP - brick / VOXTACT_COMPUTE_GROUP) / entry.w + 1;
    return groupsOfBricks(min(blocks * VOXTACT_COMPUTE_GROUP - brick % VOXTACT_COMPUTE_GROUP, count - brick));
}

/// Passes the entry to certified_finish, from a brick on.
void leaveFrom(uvec4 entry, uint brick, uint groups) {
    if (!leave(VOXTACT_LEFT_LARGE, gl_WorkGroupID.x, brick, groups)) {
        atomicOr(results[entry.x].how, VOXTACT_HOW_UNDECIDED_BIT);
    }
}

/// Returns true if the triangle certainly misses a box of bricks.
bool missesBricks(CertifiedTriangle triangle, CellBox bricks) {
    const VoxelPoint at = middleOf(bricks);
    const VoxelPoint radius = radiusOf(bricks);
    return certifiedPlaneMissesBox(triangle, at, radius) || certifiedEdgesMissBox(triangle, at, radius);
}

/// Processes the bricks of a block that may touch. Returns false if the queue has no room for one: this brick and later
/// ones go to certified_finish.
bool putBlock(uvec4 entry, CertifiedTriangle triangle, CellBox cells, int block) {
    const uint lane = gl_LocalInvocationIndex;
    const CellBox box = bricksOf(cells);
    const int count = volumeOf(box);
    if (lane < VOXTACT_COMPUTE_GROUP / 32) {
        bricksKept[lane] = 0;
    }
    barrier();
    const int own = block + int(lane);
    countWork(VOXTACT_WORK_BRICKS, own < count ? 1 : 0);
    if (own < count) {
        const ivec3 brick = placeIn(box, own);
        if (brickMayBeOpaque(brickAt(brick)) &&
            !(count > 1 && misses(triangle, brickCentre(brick), float(kBrickSide / 2)))) {
            atomicOr(bricksKept[lane >> 5], 1u << (lane & 31));
        }
    }
    barrier();
    bool fits = true;
    for (int word = 0; word < VOXTACT_COMPUTE_GROUP / 32; ++word) {
        uint left = bricksKept[word];
        while (fits && left != 0) {
            const int brick = block + 32 * word + findLSB(left);
            left &= left - 1;
            fits = putBrick(entry, triangle, cells, placeIn(box, brick));
            if (!fits && lane == 0) {
                leaveFrom(entry, uint(brick), groupsFrom(entry, uint(brick), uint(count)));
            }
        }
    }
    barrier();
    return fits;
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uvec4 entry = quads[quadOf(LARGE_WORD, gl_WorkGroupID.x)];
    if (entry.x == kNoPair || isDone(entry.x)) {
        return;
    }
    const CertifiedPair transform = transforms[entry.x];
    const TriangleVertices at = verticesOf(transform, entry.y);
    const CertifiedBounds bounds = boundsOf(at);
    const CellBox cells = cellsOf(bounds);
    const CellBox box = bricksOf(cells);
    const int count = volumeOf(box);
    if (!bounds.usable) { // one part has all
        if (lane == 0) {
            leaveFrom(entry, 0, groupsOfTriangle(transform, bounds, cells));
        }
        return;
    }
    const CertifiedTriangle triangle = triangleOf(at, bounds.delta);
    if (lane == 0) {
        certainOfGroup = 0;
    }
    bool fits = true;
    const int step = int(entry.w) * VOXTACT_COMPUTE_GROUP; // from one of the part's blocks to the next
    for (int first = int(entry.z) * VOXTACT_COMPUTE_GROUP; fits && first < count;
         first += VOXTACT_COMPUTE_GROUP * step) {
        // Tests all bricks of a block first, for one block per lane.
        if (lane < VOXTACT_COMPUTE_GROUP / 32) {
            blocksKept[lane] = 0;
        }
        barrier();
        const int own = first + int(lane) * step;
        if (own < count && !(count > VOXTACT_COMPUTE_GROUP &&
                             missesBricks(triangle, bricksFrom(box, own, min(own + VOXTACT_COMPUTE_GROUP, count) - 1)))) {
            atomicOr(blocksKept[lane >> 5], 1u << (lane & 31));
        }
        barrier();
        for (int word = 0; word < VOXTACT_COMPUTE_GROUP / 32; ++word) {
            uint left = blocksKept[word];
            while (fits && left != 0) {
                const int block = first + (32 * word + findLSB(left)) * step;
                left &= left - 1;
                fits = putBlock(entry, triangle, cells, block);
            }
        }
        barrier();
    }
    if (lane == 0 && certainOfGroup > 0) { // behind the barrier of the last block
        countWork(VOXTACT_WORK_CERTAIN, certainOfGroup);
        addSurvivors(entry.x, certainOfGroup);
    }
    if (isCut()) { // only lanes that run together agree
        atomicOr(results[entry.x].how, VOXTACT_HOW_UNDECIDED_BIT);
    }
}
