// SPDX-License-Identifier: MIT
// The projection `dominant-axis`, in the exact arithmetic of exact.h: one text for the vertex shader, the compute
// shader and the host.
#ifndef VOXTACT_DOMINANT_H
#define VOXTACT_DOMINANT_H

#include "exact.h"

/// Square voxels. A normal with only smaller components counts as none: a device may flush such numbers to zero.
#define DOMINANT_SMALLEST_NORMAL 1e-30f

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

/// a * b - c * d
EXACT float dominantCross(float a, float b, float c, float d) {
    PRECISE float first = a * b;
    PRECISE float second = c * d;
    PRECISE float difference = first - second;
    return difference;
}

EXACT float dominantMagnitude(float value) {
    return value < 0.0f ? -value : value;
}

/// A coordinate in voxels to clip space.
EXACT float dominantClip(float voxels, float clipScale) {
    PRECISE float scaled = voxels * clipScale;
    PRECISE float shifted = scaled - 1.0f;
    return shifted;
}

/// Voxel coordinates of a corner along the axes after `axis`, as pixels of the viewport.
EXACT void dominantPlace(INOUT(ExactCorner) corner, int axis, float x, float y, float z, float clipScale) {
    corner.x = dominantClip(axis == 0 ? y : (axis == 1 ? z : x), clipScale);
    corner.y = dominantClip(axis == 0 ? z : (axis == 1 ? x : y), clipScale);
    corner.z = 0.5f;
    corner.w = 1.0f;
}

/// Replaces the clip coordinates of a triangle's corners by their projection along the axis of the largest component of
/// its normal in voxel space; of equals, along the first. Returns false for a triangle without a normal, which has no
/// fragment, and keeps its corners.
EXACT bool dominantProject(INOUT(ExactCorner) c0, INOUT(ExactCorner) c1, INOUT(ExactCorner) c2, DominantGrid grid) {
    PRECISE float x0 = c0.tx * grid.sizeX;
    PRECISE float y0 = c0.ty * grid.sizeY;
    PRECISE float z0 = c0.tz * grid.sizeZ;
    PRECISE float x1 = c1.tx * grid.sizeX;
    PRECISE float y1 = c1.ty * grid.sizeY;
    PRECISE float z1 = c1.tz * grid.sizeZ;
    PRECISE float x2 = c2.tx * grid.sizeX;
    PRECISE float y2 = c2.ty * grid.sizeY;
    PRECISE float z2 = c2.tz * grid.sizeZ;
    PRECISE float ux = x1 - x0;
    PRECISE float uy = y1 - y0;
    PRECISE float uz = z1 - z0;
    PRECISE float vx = x2 - x0;
    PRECISE float vy = y2 - y0;
    PRECISE float vz = z2 - z0;
    float nx = dominantMagnitude(dominantCross(uy, vz, uz, vy));
    float ny = dominantMagnitude(dominantCross(uz, vx, ux, vz));
    float nz = dominantMagnitude(dominantCross(ux, vy, uy, vx));
    // Comparisons with NaN are false.
    bool numbers = nx >= 0.0f && ny >= 0.0f && nz >= 0.0f;
    bool large = nx >= DOMINANT_SMALLEST_NORMAL || ny >= DOMINANT_SMALLEST_NORMAL || nz >= DOMINANT_SMALLEST_NORMAL;
    if (!numbers || !large) {
        return false;
    }
    int axis = (nx >= ny && nx >= nz) ? 0 : (ny >= nz ? 1 : 2);
    dominantPlace(c0, axis, x0, y0, z0, grid.clipScale);
    dominantPlace(c1, axis, x1, y1, z1, grid.clipScale);
    dominantPlace(c2, axis, x2, y2, z2, grid.clipScale);
    return true;
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
