// SPDX-License-Identifier: MIT
// The counting method `compute`: covers the pixels that a rasteriser covers, in the exact arithmetic of exact.h. A
// triangle with few pixels is one lane's; one with many is queued and shared by the whole group, so that a huge
// triangle does not serialise; and by as many groups along z as the host has taken for those that are huge.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#ifdef OUTPUTS
#extension GL_EXT_samplerless_texture_functions : require
#endif
#include "exact/shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
layout(constant_id = VOXTACT_CONSTANT_EXACT_FILTER) const bool kExactFilter = true;
layout(constant_id = VOXTACT_CONSTANT_VIEWS) const uint kViews = 1; // of a pair
layout(constant_id = VOXTACT_CONSTANT_DOMINANT_AXIS) const bool kDominantAxis = false;

layout(set = VOXTACT_SET_VOLUME, binding = 0) uniform sampler3D volume;
layout(set = VOXTACT_SET_TRANSFER_FUNCTION, binding = 0) uniform sampler1D transferFunction;
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) readonly buffer Transforms {
    PairTransform transforms[];
};
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_RESULTS, std430) buffer Results { PairResult results[]; };
layout(set = VOXTACT_SET_MESH, binding = VOXTACT_BINDING_VERTICES, std430) readonly buffer Vertices { float vertices[]; };
layout(set = VOXTACT_SET_MESH, binding = VOXTACT_BINDING_INDICES, std430) readonly buffer Indices { uint indices[]; };
layout(push_constant) uniform Item { ComputeConstants constants; };

// One addition per work group: an unneeded carry costs nothing.
const bool kCarry = true;
const bool kYesNo = false;

#include "survives.glsl"
#include "count.glsl"
#include "exact/dominant.h"
#include "scene/mesh.glsl"
#ifdef OUTPUTS
#include "outputs.glsl"
uint pairAtWork;
uint triangleAtWork;
#endif

/// A piece is a triangle, or one triangle of its fan after clipping: triangle * 8 + number in the fan.
#define MOST_PIECES (EXACT_MAX_CORNERS - 2)
const int kMostPixelsOfALane = 64;

shared uint queue[VOXTACT_COMPUTE_GROUP * MOST_PIECES];
shared uint queued;
shared uint groupLow; // passing fragments of the work group: their sum exceeds 32 bits
shared uint groupHigh;

/// Returns the number of pieces of a triangle. Stores the corners of the polygon in `exactPolygon`.
int piecesOf(PairTransform transform, uint triangle) {
    for (uint corner = 0; corner < 3; ++corner) {
        exactPolygon[corner] = cornerOf(constants.mesh, transform, 3 * triangle + corner);
    }
    if (constants.rangeTest != 0 && exactBeyond(exactPolygon[0], exactPolygon[1], exactPolygon[2])) {
        return 0;
    }
    if (kDominantAxis && !dominantProject(exactPolygon[0], exactPolygon[1], exactPolygon[2], constants.grid)) {
        return 0;
    }
    const float guardX = constants.guardX;
    const float guardY = constants.guardY;
    if (exactInside(exactPolygon[0], guardX, guardY) && exactInside(exactPolygon[1], guardX, guardY) &&
        exactInside(exactPolygon[2], guardX, guardY)) {
        return 1;
    }
    return max(exactClip(3, guardX, guardY) - 2, 0);
}

uint countPixel(ExactTriangle piece, int x, int y) {
    vec3 coordinate;
    const bool covered = exactFragment(piece, x, y, coordinate.x, coordinate.y, coordinate.z);
    const bool survivor = covered && survives(coordinate, constants.item, constants.rangeTest != 0, kExactFilter);
#ifdef OUTPUTS
    if (survivor) {
        emitSurvivor(pairAtWork, triangleAtWork, coordinate);
    }
#endif
    return survivor ? 1u : 0u;
}

/// Every step-th pixel of the piece's box, from `first` on.
uint countPixels(ExactTriangle piece, int first, int step) {
    const int columns = piece.maxX - piece.minX + 1;
    const int pixels = columns * (piece.maxY - piece.minY + 1);
    uint survivors = 0;
    for (int pixel = first; pixel < pixels; pixel += step) {
        survivors += countPixel(piece, piece.minX + pixel % columns, piece.minY + pixel / columns);
    }
    return survivors;
}

/// Counts the small pieces of a lane's own triangle, and queues the others. With `isQueued`: counts this lane's pixels
/// of a queued piece, number `queuedNumber` of its triangle. Every lane sets that piece up again, which is cheaper than
/// storing it. One function for both, because shader compilers inline every call.
uint countPieces(PairTransform transform, uint triangle, bool isQueued, uint queuedNumber) {
#ifdef OUTPUTS
    triangleAtWork = triangle;
#endif
    int end = piecesOf(transform, triangle);
    int number = 0;
    int first = 0;
    int step = 1;
    if (isQueued) {
        number = int(queuedNumber);
        end = number + 1;
        first = int(gl_LocalInvocationIndex + VOXTACT_COMPUTE_GROUP * gl_WorkGroupID.z);
        step = int(VOXTACT_COMPUTE_GROUP * gl_NumWorkGroups.z);
    }
    uint survivors = 0;
    for (; number < end; ++number) {
        ExactTriangle piece;
        if (!exactSetUp(exactPolygon[0], exactPolygon[number + 1], exactPolygon[number + 2], constants.width,
                        constants.height, piece)) {
            continue;
        }
        const int pixels = (piece.maxX - piece.minX + 1) * (piece.maxY - piece.minY + 1);
        if (isQueued || (pixels <= kMostPixelsOfALane && gl_WorkGroupID.z == 0)) {
            survivors += countPixels(piece, first, step);
        } else if (pixels > kMostPixelsOfALane) {
            queue[atomicAdd(queued, 1u)] = triangle * 8 + uint(number);
        }
    }
    return survivors;
}

void main() {
    if (gl_LocalInvocationIndex == 0) {
        queued = 0;
        groupLow = 0;
        groupHigh = 0;
    }
    barrier();
    const uint view = constants.firstTransform + gl_WorkGroupID.y;
    const uint pair = view / kViews;
#ifdef OUTPUTS
    pairAtWork = pair;
#endif
    const uint triangle = constants.firstTriangle + gl_GlobalInvocationID.x;
    const PairTransform transform = transforms[view];
    uint survivors = 0;
    uint turns = 1;
    for (uint turn = 0; turn < turns; ++turn) { // its own triangle, then the queued pieces, with all lanes
        const bool isQueued = turn > 0;
        const uint entry = isQueued ? queue[turn - 1] : 0;
        const uint at = isQueued ? entry / 8 : triangle;
        if (at < constants.triangleCount) {
            survivors += countPieces(transform, at, isQueued, entry % 8);
        }
        if (turn == 0) {
            barrier();
            turns += queued;
        }
    }
    if (survivors > 0) {
        const uint before = atomicAdd(groupLow, survivors);
        if (before + survivors < before) {
            atomicAdd(groupHigh, 1u);
        }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0) {
        addSurvivors(pair, groupLow, groupHigh);
    }
}
