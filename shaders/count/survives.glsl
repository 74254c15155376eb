// SPDX-License-Identifier: MIT
// The look-up of the paper's fragment program, by both filters. Expects `volume` and `transferFunction`.
#ifndef VOXTACT_SURVIVES_GLSL
#define VOXTACT_SURVIVES_GLSL

#include "exact/exact.h"
#include "stored.glsl"

/// Trilinear in fp32: along x, then y, then z. `coordinate` in [0,1]^3.
float exactStored(vec3 coordinate, float unit) {
    const ivec3 size = textureSize(volume, 0);
    const ExactCell x = exactCell(coordinate.x, size.x);
    const ExactCell y = exactCell(coordinate.y, size.y);
    const ExactCell z = exactCell(coordinate.z, size.z);
    const float v00 = exactLerp(storedVoxel(ivec3(x.below, y.below, z.below), unit),
                                storedVoxel(ivec3(x.above, y.below, z.below), unit), x.weight);
    const float v10 = exactLerp(storedVoxel(ivec3(x.below, y.above, z.below), unit),
                                storedVoxel(ivec3(x.above, y.above, z.below), unit), x.weight);
    const float v01 = exactLerp(storedVoxel(ivec3(x.below, y.below, z.above), unit),
                                storedVoxel(ivec3(x.above, y.below, z.above), unit), x.weight);
    const float v11 = exactLerp(storedVoxel(ivec3(x.below, y.above, z.above), unit),
                                storedVoxel(ivec3(x.above, y.above, z.above), unit), x.weight);
    return exactLerp(exactLerp(v00, v10, y.weight), exactLerp(v01, v11, y.weight), z.weight);
}

float exactTable(float stored, ItemConstants item) {
    const ExactCell entry = exactEntry(stored, item.scalarScale, item.scalarBias, textureSize(transferFunction, 0));
    return exactLerp(texelFetch(transferFunction, entry.below, 0).r, texelFetch(transferFunction, entry.above, 0).r,
                     entry.weight);
}

float exactOpacity(vec3 coordinate, ItemConstants item) {
    const vec3 inside = vec3(exactClamp(coordinate.x), exactClamp(coordinate.y), exactClamp(coordinate.z));
    return exactTable(exactStored(inside, item.storedUnit), item);
}

float hardwareOpacity(vec3 coordinate, ItemConstants item) {
    // Explicit level: after a discard there are no derivatives.
    const float texel = textureLod(volume, coordinate, 0.0).r;
    return textureLod(transferFunction, texel * item.scalarScale + item.scalarBias, 0.0).r;
}

/// Returns true if the fragment passes in the paper's fragment program. NaN fails every comparison.
bool survives(vec3 coordinate, ItemConstants item, bool rangeTest, bool exact) {
    if (rangeTest &&
        !(exactInDomain(coordinate.x) && exactInDomain(coordinate.y) && exactInDomain(coordinate.z))) {
        return false;
    }
    const float opacity = exact ? exactOpacity(coordinate, item) : hardwareOpacity(coordinate, item);
    return opacity >= item.threshold;
}

#endif
