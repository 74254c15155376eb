// SPDX-License-Identifier: MIT
// Where clearances are measured, the decision: a lane a cell of a triangle, which it looks into as long as something in
// it may be nearer than what is known.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define MARGIN
#define CLEARANCE
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"
#include "certified_clearance_cell.glsl"

void main() {
    const uint number = gl_GlobalInvocationID.x;
    uvec4 entry = uvec4(kNoPair, 0, 0, 0);
    if (number < min(queueCount(VOXTACT_QUEUE_CELLS), VOXTACT_ROOM_CELLS(constants.queueRoom))) {
        entry = quads[quadOf(VOXTACT_WORD_CELLS, number)];
    }
    if (entry.x == kNoPair || isDone(entry.x)) {
        return;
    }
    countWork(VOXTACT_WORK_DECIDED, 1);
    const ivec3 cell = unpackCell(entry.zw);
    const TriangleVertices at = verticesOf(transforms[entry.x], entry.y);
    const CertifiedTriangle triangle = triangleOf(at, boundsOf(entry.x, at).delta);
    ClearanceFound found = nothingFound();
    const float below =
        measureCell(entry.x, triangle, cell, brickAt((cell + 1) >> VOXTACT_BRICK_SHIFT), found);
    tellFound(entry.x, entry.y, found, below);
}
