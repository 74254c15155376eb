// SPDX-License-Identifier: MIT
// The ranges of the stored values of bricks (src/core/volume/bricks.h), a work group per brick: of all the corners of
// its cells, and of those of the cells one farther out too. A NaN counts for neither end: every sample that it has a
// part in is NaN, which is never opaque. A brick of nothing else has an empty range, +inf to -inf.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "exact/shared.h"

layout(local_size_x = VOXTACT_BRICK_GROUP) in;

layout(set = VOXTACT_SET_VOLUME, binding = 0) uniform sampler3D volume;
layout(set = VOXTACT_SET_VOLUME, binding = VOXTACT_BINDING_BRICKS, std430) buffer Bricks {
    vec4 bricks[]; // lo, hi, wideLo, wideHi
};
layout(push_constant) uniform Item { BrickConstants constants; };

#include "count/stored.glsl"

#define INFINITE uintBitsToFloat(0x7f800000u)

shared vec4 ranges[VOXTACT_BRICK_GROUP];

/// Returns the union of two pairs of ranges.
vec4 joined(vec4 a, vec4 b) {
    return vec4(min(a.x, b.x), max(a.y, b.y), min(a.z, b.z), max(a.w, b.w));
}

/// Returns the ranges of every 64th voxel of the wide box, from this lane's voxel on.
vec4 rangesOfLane(ivec3 brick) {
    const ivec3 corner = brick << VOXTACT_BRICK_SHIFT;
    const ivec3 lastVoxel = textureSize(volume, 0) - 1;
    const ivec3 first = max(corner - 1, 0);
    const ivec3 last = min(corner + (1 << VOXTACT_BRICK_SHIFT) - 1, lastVoxel);
    const ivec3 wideFirst = max(corner - 2, 0);
    const ivec3 wideSize = min(corner + (1 << VOXTACT_BRICK_SHIFT), lastVoxel) - wideFirst + 1;
    const int voxels = wideSize.x * wideSize.y * wideSize.z;
    vec4 found = vec4(INFINITE, -INFINITE, INFINITE, -INFINITE);
    for (int i = int(gl_LocalInvocationIndex); i < voxels; i += VOXTACT_BRICK_GROUP) {
        const int row = i / wideSize.x;
        const ivec3 voxel = wideFirst + ivec3(i % wideSize.x, row % wideSize.y, row / wideSize.y);
        const float stored = storedVoxel(voxel, constants.storedUnit);
        if (isnan(stored)) {
            continue;
        }
        const bool inside = all(greaterThanEqual(voxel, first)) && all(lessThanEqual(voxel, last));
        found = joined(found, vec4(inside ? stored : INFINITE, inside ? stored : -INFINITE, stored, stored));
    }
    return found;
}

void main() {
    const ivec3 brick = ivec3(constants.firstX, constants.firstY, constants.firstZ) + ivec3(gl_WorkGroupID);
    const uint lane = gl_LocalInvocationIndex;
    ranges[lane] = rangesOfLane(brick);
    for (uint reach = VOXTACT_BRICK_GROUP / 2; reach > 0; reach /= 2) {
        barrier();
        if (lane < reach) {
            ranges[lane] = joined(ranges[lane], ranges[lane + reach]);
        }
    }
    if (lane == 0) {
        const ivec3 count = (textureSize(volume, 0) >> VOXTACT_BRICK_SHIFT) + 1;
        bricks[brick.x + count.x * (brick.y + count.y * brick.z)] = ranges[0];
    }
}
