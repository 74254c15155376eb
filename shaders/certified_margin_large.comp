// SPDX-License-Identifier: MIT
// The projection `conservative` with a margin, the cells near a triangle: a work group has one brick of it, whose cells
// the lanes share. Those that need a decision go into the queue of cells. A triangle that is near very many bricks is
// left to certified_margin_finish, whose work groups share it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define MARGIN
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

shared uint full; // the queue of cells is

/// Puts the lane's cells of a brick into the queue. False where that is full.
bool putCells(uvec4 entry, CertifiedTriangle triangle, CellBox cells, ivec3 brick) {
    const CellBox inside = within(cells, brick);
    const vec4 range = brickAt(brick);
    const int most = volumeOf(inside);
    const uint room = VOXTACT_ROOM_CELLS(constants.queueRoom);
    bool fits = true;
    countWork(VOXTACT_WORK_CELLS, gl_LocalInvocationIndex == 0 ? uint(most) : 0);
    for (int i = int(gl_LocalInvocationIndex); i < most; i += VOXTACT_COMPUTE_GROUP) {
        const ivec3 cell = placeIn(inside, i);
        if (marginCellNeeds(triangle, cell, range)) {
            const uint place = reserve(VOXTACT_QUEUE_CELLS, 1, room, VOXTACT_COMPUTE_GROUP);
            fits = fits && place < room;
            if (place < room) {
                quads[quadOf(VOXTACT_WORD_CELLS, place)] = uvec4(entry.x, entry.y, packCell(cell));
            }
        }
    }
    return fits;
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uvec4 entry = quads[quadOf(VOXTACT_WORD_LARGE(constants.queueRoom), gl_WorkGroupID.x)];
    if (lane == 0) {
        full = 0;
    }
    barrier();
    if (isDone(entry.x)) {
        return;
    }
    const CertifiedPair transform = transforms[entry.x];
    const TriangleVertices at = verticesOf(transform, entry.y);
    const CertifiedBounds bounds = boundsOf(at);
    const CellBox cells = cellsOf(bounds);
    if (entry.w != 0) { // all of the triangle
        if (lane == 0) {
            leave(VOXTACT_LEFT_LARGE, gl_WorkGroupID.x, 0, groupsOfTriangle(transform, bounds, cells));
        }
        return;
    }
    const bool fits =
        putCells(entry, triangleOf(at, bounds.delta), cells, placeIn(bricksOf(cells), int(entry.z)));
    // One lane says so for all: what is decided twice does no harm.
    if ((!fits || isCut()) && atomicOr(full, 1u) == 0) {
        leave(VOXTACT_LEFT_LARGE, gl_WorkGroupID.x, entry.z, 1);
    }
}
