// SPDX-License-Identifier: MIT
// Where clearances are measured, the decision: a lane per cell of a triangle, which it looks into as long as something
// in it may be nearer than what is known. With PROBE, before all of them are, only the first cell of a brick on the way
// from its nearest triangle: that bounds the distance above.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define MARGIN
#define CLEARANCE
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"
#include "certified_clearance_cell.glsl"
#include "certified_clearance_bits.glsl"

#ifdef PROBE
uvec4 cellOfLane(uint number) {
    if (number >= queueCount(VOXTACT_QUEUE_PROBES)) {
        return uvec4(kNoPair, 0, 0, 0);
    }
    const uint at = queues[constants.queueWord + VOXTACT_WORD_NEAREST(constants.queueRoom) + number];
    const uvec4 entry = quads[quadOf(LARGE_WORD, at)];
    const ivec3 corner = (brickOf(int(brickOfEntry(entry.z))) << VOXTACT_BRICK_SHIFT) - 1;
    const uint own = entry.z >> VOXTACT_FIRST_TRIANGLE_SHIFT & (VOXTACT_RUN_TRIANGLES - 1);
    return uvec4(entry.x, triangleAt(entry.y * VOXTACT_RUN_TRIANGLES + own),
                 packCell(corner + cellInBrick(entry.z >> VOXTACT_FIRST_CELL_SHIFT)));
}
#else
uvec4 cellOfLane(uint number) {
    if (number >= queueCount(VOXTACT_QUEUE_OPEN)) {
        return uvec4(kNoPair, 0, 0, 0);
    }
    const uint at = queues[constants.queueWord + VOXTACT_WORD_CLEARANCE_OPEN(constants.queueRoom) + number];
    const uvec4 entry = quads[quadOf(VOXTACT_WORD_CELLS, at)];
    return uvec4(entry.xyz, entry.w & (1u << VOXTACT_BELOW_SHIFT) - 1);
}
#endif

void main() {
    const uvec4 entry = cellOfLane(gl_GlobalInvocationID.x);
    if (entry.x == kNoPair || isDone(entry.x)) {
        return;
    }
    const ivec3 cell = unpackCell(entry.zw);
    const TriangleVertices at = verticesOf(transforms[entry.x], entry.y);
    const CertifiedTriangle triangle = triangleOf(at, boundsOf(entry.x, at).delta);
    ClearanceFound found = nothingFound();
    const float below =
        measureCell(entry.x, triangle, cell, brickAt((cell + 1) >> VOXTACT_BRICK_SHIFT), found);
    tellFound(entry.x, entry.y, found, below);
}
