// SPDX-License-Identifier: MIT
// The projection `conservative` with a margin, the decision: a lane per cell. What it leaves undecided is *possible*.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define MARGIN
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

int decide(uvec4 entry) {
    const ivec3 cell = unpackCell(entry.zw);
    const TriangleVertices at = verticesOf(transforms[entry.x], entry.y);
    const CertifiedTriangle triangle = triangleOf(at, boundsOf(entry.x, at).delta);
    const CertifiedCorners corners = cornersOf(cell, brickAt((cell + 1) >> VOXTACT_BRICK_SHIFT));
    const CertifiedCell known = certifiedCell(constants.item, corners, cell.x, cell.y, cell.z, triangle.delta);
    return marginDecide(opacities(), MARGIN_SPACE(entry.x), triangle, known,
                        voxelPoint(float(cell.x), float(cell.y), float(cell.z)));
}

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
    const int verdict = decide(entry);
    if (isCut() || verdict == CERTIFIED_UNDECIDED) {
        markUndecided(entry.x);
    } else if (verdict == CERTIFIED_CERTAIN) {
        markWithin(entry.x);
    }
}
