// SPDX-License-Identifier: MIT
// The projection `conservative` with a margin, the cells near a triangle: a work group has one brick of it, or blocks of
// as many bricks as it has lanes. The lanes share the bricks, and then the cells of each brick.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define MARGIN
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

// The cells of a brick.
#define VOXTACT_CELL_LIST 512
#include "certified_cells.glsl"

shared uint bricksKept[VOXTACT_COMPUTE_GROUP / 32];
shared uint over; // nothing is left to be done

/// Lists those of a brick's cells that need a decision, and puts them into the queue; what is certain without one is
/// in `certainOfGroup`. False where the queue has no room.
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
    for (int i = int(lane); i < most; i += VOXTACT_COMPUTE_GROUP) {
        const int verdict = marginCellVerdict(triangle, placeIn(inside, i), range);
        if (verdict == CERTIFIED_UNDECIDED) {
            list[atomicAdd(listed, 1u)] = uint(i);
        } else if (verdict == CERTIFIED_CERTAIN && !isCut()) {
            atomicAdd(certainOfGroup, 1u);
        }
    }
    barrier();
    if (certainOfGroup > 0) {
        return true;
    }
    const bool fits = reserveList();
    for (uint i = lane; fits && i < listed; i += VOXTACT_COMPUTE_GROUP) {
        putCell(i, entry.x, entry.y, placeIn(inside, int(list[i])));
    }
    barrier();
    return fits;
}

/// The work groups that certified_margin_finish needs for what an entry has from a brick on.
uint groupsFrom(uvec4 entry, uint brick, uint count) {
    if (entry.w == 0) {
        return 1;
    }
    const uint blocks = ((count - 1) / VOXTACT_COMPUTE_GROUP - brick / VOXTACT_COMPUTE_GROUP) / entry.w + 1;
    return groupsOfBricks(min(blocks * VOXTACT_COMPUTE_GROUP - brick % VOXTACT_COMPUTE_GROUP, count - brick));
}

/// A bit for each of 64 bricks from `block` on that may have something opaque within the margin.
void keepBricks(uvec4 entry, CertifiedTriangle triangle, CellBox box, int block) {
    const uint lane = gl_LocalInvocationIndex;
    if (lane < VOXTACT_COMPUTE_GROUP / 32) {
        bricksKept[lane] = 0;
    }
    barrier();
    const int own = block + int(lane);
    if (entry.w == 0) { // was looked at
        if (own == int(entry.z)) {
            atomicOr(bricksKept[lane >> 5], 1u << (lane & 31));
        }
    } else if (own < volumeOf(box)) {
        countWork(VOXTACT_WORK_BRICKS, 1);
        if (marginBrickMay(triangle, placeIn(box, own))) {
            atomicOr(bricksKept[lane >> 5], 1u << (lane & 31));
        }
    }
    barrier();
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uvec4 entry = quads[quadOf(VOXTACT_WORD_LARGE(constants.queueRoom), gl_WorkGroupID.x)];
    if (lane == 0) {
        over = entry.x == kNoPair || isDone(entry.x) ? 1 : 0;
        certainOfGroup = 0;
    }
    barrier();
    if (over != 0) {
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
            leave(VOXTACT_LEFT_LARGE, gl_WorkGroupID.x, 0, groupsOfTriangle(transform, bounds, cells));
        }
        return;
    }
    const CertifiedTriangle triangle = triangleOf(at, bounds.delta);
    const bool oneBrick = entry.w == 0;
    const int first = int(oneBrick ? entry.z / VOXTACT_COMPUTE_GROUP : entry.z) * VOXTACT_COMPUTE_GROUP;
    const int end = oneBrick ? first + 1 : count;
    bool goesOn = true;
    for (int block = first; goesOn && block < end; block += int(max(entry.w, 1u)) * VOXTACT_COMPUTE_GROUP) {
        keepBricks(entry, triangle, box, block);
        for (int word = 0; word < VOXTACT_COMPUTE_GROUP / 32; ++word) {
            uint left = bricksKept[word];
            while (goesOn && left != 0) {
                const int brick = block + 32 * word + findLSB(left);
                left &= left - 1;
                const bool fits = putBrick(entry, triangle, cells, placeIn(box, brick));
                if (!fits && lane == 0) {
                    leave(VOXTACT_LEFT_LARGE, gl_WorkGroupID.x, uint(brick),
                          groupsFrom(entry, uint(brick), uint(count)));
                }
                goesOn = fits && certainOfGroup == 0;
            }
        }
        barrier();
    }
    if (lane == 0 && certainOfGroup > 0) {
        countWork(VOXTACT_WORK_CERTAIN, 1);
        markWithin(entry.x);
    }
    if (isCut()) { // lanes that run together are: others are not
        atomicOr(results[entry.x].how, VOXTACT_HOW_UNDECIDED_BIT);
    }
}
