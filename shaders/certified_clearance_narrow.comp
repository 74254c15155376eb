// SPDX-License-Identifier: MIT
// Where clearances are measured, before the decision: a lane per cell of a triangle looks at it as a whole. Then, with
// AGAIN, those go on in which what may be opaque may be nearer than what is known by then.
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

void main() {
    const uint number = gl_GlobalInvocationID.x;
    const uint room = VOXTACT_ROOM_CELLS(constants.queueRoom);
    if (number >= min(queueCount(VOXTACT_QUEUE_CELLS), room)) {
        return;
    }
    const uint place = quadOf(VOXTACT_WORD_CELLS, number);
    const uvec4 entry = quads[place];
    if (isDone(entry.x)) {
        return;
    }
    const MarginSpace by = clearanceSpace(entry.x);
#ifdef AGAIN
    if (belowOf(entry.x, entry.w) < by.margin) {
        queues[constants.queueWord + VOXTACT_WORD_CLEARANCE_OPEN(constants.queueRoom) +
               reserve(VOXTACT_QUEUE_OPEN, 1, room, VOXTACT_COMPUTE_GROUP)] = number;
    }
#else
    countWork(VOXTACT_WORK_DECIDED, 1);
    const ivec3 at = unpackCell(entry.zw);
    const TriangleVertices vertices = verticesOf(transforms[entry.x], entry.y);
    const CertifiedTriangle triangle = triangleOf(vertices, boundsOf(entry.x, vertices).delta);
    const vec4 range = brickAt((at + 1) >> VOXTACT_BRICK_SHIFT);
    const CertifiedCell cell =
        certifiedCell(constants.item, cornersOf(at, range), at.x, at.y, at.z, triangle.delta);
    const VoxelPoint corner = voxelPoint(float(at.x), float(at.y), float(at.z));
    ClearanceFound found = nothingFound();
    found.hi = clearanceHi(entry.x);
    const MarginTriangle about = marginTriangle(by, triangle, corner, 1.0);
#ifdef OF_LABEL
    float below = VOXTACT_CLEARANCE_FAR;
    uint left = octantsOf(at).own;
    while (left != 0) {
        const uint part = nextPart(left);
        left &= ~part;
        below = min(below, firstLook(by, partOfCell(cell, part), at, about, found));
    }
#else
    const float below = firstLook(by, cell, at, about, found);
#endif
    if (isCut()) {
        return; // of which nothing is known
    }
    quads[place].w = withBelow(entry.x, entry.w, below);
    if (found.hi < clearanceHi(entry.x)) {
        foundAt(entry.x, entry.y, found.hi, found.place);
    }
#endif
}
