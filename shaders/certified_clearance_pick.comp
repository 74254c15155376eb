// SPDX-License-Identifier: MIT
// Where clearances are measured: which entries of the queue of large triangles are still near enough for the next pass. A
// lane a near one. With PROBE that pass only bounds the distance above.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define MARGIN
#define CLEARANCE
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"
#include "certified_clearance_bits.glsl"

void main() {
    if (gl_GlobalInvocationID.x >= queueCount(VOXTACT_QUEUE_NEAR)) {
        return;
    }
    const uint number = queues[nearWord(gl_GlobalInvocationID.x)];
    const uvec4 entry = quads[quadOf(LARGE_WORD, number)];
    const bool whole = (entry.w & VOXTACT_MARGIN_ALL) != 0;
    const bool near = (entry.w & VOXTACT_MARGIN_ALL - 1) != 0 && !isDone(entry.x) &&
                      belowOf(entry.x, entry.w) < clearanceSpace(entry.x).margin;
#ifdef PROBE
    if (near && (entry.z & VOXTACT_HAS_SLOT) != 0) {
        queues[nearestWord(reserve(VOXTACT_QUEUE_PROBES, 1, LARGE_ROOM, VOXTACT_COMPUTE_GROUP))] = number;
    }
#else
    if (near || (whole && !isDone(entry.x))) {
        const uint room = VOXTACT_ROOM_NEAREST(constants.queueRoom);
        const uint place = reserve(VOXTACT_QUEUE_NEAREST, 1, room, 1);
        if (place < room) {
            queues[nearestWord(place)] = number;
        } else {
            refuse(entry.x);
        }
    }
#endif
}
