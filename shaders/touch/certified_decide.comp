// SPDX-License-Identifier: MIT
// The projection `certified`, the decision: a lane per cell. What single precision leaves undecided goes to
// certified_finish.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#ifdef OUTPUTS
#extension GL_EXT_samplerless_texture_functions : require
#endif
#include "exact/shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

shared uint pairOfGroup; // pair of the first lane, and so of most lanes
shared uint survivors;   // of that pair
shared uint open;
shared uint firstOpen;

int decide(uvec4 entry) {
    const ivec3 cell = unpackCell(entry.zw);
    const TriangleVertices at = verticesOf(transforms[entry.x], entry.y);
    const CertifiedTriangle triangle = triangleOf(at, boundsOf(at).delta);
    const CertifiedCorners corners = cornersOf(cell, brickAt((cell + 1) >> VOXTACT_BRICK_SHIFT));
    const CertifiedCell known = certifiedCell(constants.item, corners, cell.x, cell.y, cell.z, triangle.delta);
    // The pass that listed the cell did the tests of certifiedBegin().
    const int count = certifiedClip(triangle, known, voxelPoint(float(cell.x), float(cell.y), float(cell.z)));
    CertifiedWitness witness;
    const int verdict = certifiedSettle(opacities(), constants.item.resolution, known, count, witness);
#ifdef OUTPUTS
    if (verdict == CERTIFIED_CERTAIN && !isCut()) {
        emitWitness(entry.x, entry.y, corners, witness, cell);
    }
#endif
    return verdict;
}

void main() {
    const uint number = gl_GlobalInvocationID.x;
    uvec4 entry = uvec4(kNoPair, 0, 0, 0);
    if (number < min(queueCount(VOXTACT_QUEUE_CELLS), VOXTACT_ROOM_CELLS(constants.queueRoom))) {
        entry = quads[quadOf(VOXTACT_WORD_CELLS, number)];
    }
    const bool some = entry.x != kNoPair && !isDone(entry.x);
    if (gl_LocalInvocationIndex == 0) {
        pairOfGroup = entry.x;
        survivors = 0;
        open = 0;
    }
    barrier();
    bool isOpen = false;
    countWork(VOXTACT_WORK_DECIDED, some ? 1 : 0);
    if (some) {
        const int verdict = decide(entry);
        if (isCut()) {
            atomicOr(results[entry.x].how, VOXTACT_HOW_UNDECIDED_BIT);
        } else if (verdict == CERTIFIED_CERTAIN) {
            if (entry.x == pairOfGroup) {
                atomicAdd(survivors, 1u);
            } else {
                addSurvivors(entry.x, 1);
            }
        } else {
            isOpen = verdict == CERTIFIED_UNDECIDED;
        }
    }
    uint slot = 0;
    if (isOpen) {
        slot = atomicAdd(open, 1u);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0) {
        if (survivors > 0) {
            addSurvivors(pairOfGroup, survivors);
        }
        if (open > 0) {
            firstOpen =
                reserve(VOXTACT_QUEUE_OPEN, open, VOXTACT_ROOM_CELLS(constants.queueRoom), VOXTACT_COMPUTE_GROUP);
        }
    }
    barrier();
    if (isOpen) {
        queues[constants.queueWord + VOXTACT_WORD_OPEN(constants.queueRoom) + firstOpen + slot] = number;
    }
}
