// SPDX-License-Identifier: MIT
// Where clearances are measured: a lane an entry of the queue of large triangles. What may be opaque in its brick is no
// nearer to the box of its run than the shadows of both are to each other, on the way from the one to the other. Those
// go on that may be nearer than what is known.
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
#include "certified_clearance_way.glsl"

/// The shadow of a box of triangles, about a point: the greatest.
float boxShadow(VoxelPoint pulled, CertifiedReach reach, VoxelPoint about) {
    const VoxelPoint lo = voxelDifference(reach.lo, about);
    const VoxelPoint hi = voxelDifference(reach.hi, about);
    return max(pulled.x * lo.x, pulled.x * hi.x) + max(pulled.y * lo.y, pulled.y * hi.y) +
           max(pulled.z * lo.z, pulled.z * hi.z);
}

float belowOfRun(MarginSpace by, CertifiedReach reach, uint z) {
    const vec3 centre = brickCentre(brickOf(int(brickOfEntry(z))));
    const VoxelPoint middle = voxelPoint(centre.x, centre.y, centre.z);
    const float r = MARGIN_BRICK_RADIUS;
    const VoxelPoint apart = voxelPoint(marginApart(reach.lo.x, reach.hi.x, middle.x, r),
                                        marginApart(reach.lo.y, reach.hi.y, middle.y, r),
                                        marginApart(reach.lo.z, reach.hi.z, middle.z, r));
    const VoxelPoint along = marginFlat(by, apart);
    const VoxelPoint pulled = marginPulled(by, along);
    const float farthest =
        max(voxelLength(voxelDifference(reach.lo, middle)), voxelLength(voxelDifference(reach.hi, middle))) + 2.0 * r;
    return clearanceBelow(firstOnWay(z, pulled).least - boxShadow(pulled, reach, middle), voxelDot(along, along),
                          2.0 * marginSlack(by, reach.delta, farthest));
}

void main() {
    const uint number = gl_GlobalInvocationID.x;
    if (number >= min(queueCount(VOXTACT_QUEUE_LARGE), LARGE_ROOM)) {
        return;
    }
    const uvec4 entry = quads[quadOf(LARGE_WORD, number)];
    if (isDone(entry.x)) {
        return;
    }
    const MarginSpace by = clearanceSpace(entry.x);
    if ((entry.w & VOXTACT_MARGIN_ALL) == 0 && constants.clusterWord != VOXTACT_NO_CLUSTERS) {
        const CertifiedReach reach = certifiedBoxReach(transforms[entry.x], boxOfRun(entry.y));
        if (belowOfRun(by, reach, entry.z) >= by.margin && !isCut()) {
            return;
        }
    }
    queues[nearWord(reserve(VOXTACT_QUEUE_NEAR, 1, LARGE_ROOM, VOXTACT_COMPUTE_GROUP))] = number;
}
