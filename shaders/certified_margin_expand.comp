// SPDX-License-Identifier: MIT
// The projection `conservative` with a margin, the bricks near triangles: a work group has four runs, a lane each
// triangle. The bricks that may have something opaque within the margin of one go into the queue of large triangles, one
// an entry; those of a triangle that is near many are shared by work groups.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define MARGIN
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

/// Bricks of a lane.
const int kMostBricks = 32;

shared uint parts; // that the work group has
shared uint firstPart;
shared uint groupsIfLeft; // of certified_margin_finish, for all of it

/// Bricks that are too many for a lane; also where their number overflows.
bool isShared(CellBox bricks) {
    const ivec3 sides = bricks.hi - bricks.lo + 1;
    return any(greaterThan(sides, ivec3(kMostBricks))) || volumeOf(bricks) > kMostBricks;
}

/// Work groups of certified_margin_large that share a triangle: one for every 64 bricks, up to a point.
uint partsOf(CellBox bricks) {
    const float kMostParts = 64.0;
    const vec3 size = vec3(bricks.hi - bricks.lo + 1);
    return uint(clamp(size.x * size.y * size.z * (1.0 / float(VOXTACT_COMPUTE_GROUP)), 1.0, kMostParts));
}

/// A bit for each brick that may have something opaque within the margin.
uint bricksNear(CertifiedTriangle triangle, CellBox bricks) {
    const int count = volumeOf(bricks);
    uint bits = 0;
    countWork(VOXTACT_WORK_BRICKS, uint(count));
    for (int i = 0; i < count; ++i) {
        bits |= marginBrickMay(triangle, placeIn(bricks, i)) ? 1u << i : 0;
    }
    return bits;
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0) {
        parts = 0;
        groupsIfLeft = 0;
    }
    barrier();
    const TriangleLane own = triangleLane(gl_WorkGroupID.x, lane);
    uint shares = 0; // of a triangle whose bricks are shared
    uint bits = 0;
    if (own.some) {
        const TriangleVertices at = verticesOf(transforms[own.pair], own.number);
        const CertifiedBounds bounds = boundsOf(at);
        const CellBox cells = cellsOf(bounds);
        if (!isEmpty(cells)) {
            // Those of pairs that are done, too: certified_margin_finish must find the same, and more will be done then.
            atomicAdd(groupsIfLeft, groupsOfTriangle(transforms[own.pair], bounds, cells));
            if (!isDone(own.pair)) {
                const CellBox bricks = bricksOf(cells);
                if (!bounds.usable) {
                    shares = 1;
                } else if (isShared(bricks)) {
                    shares = partsOf(bricks);
                } else {
                    bits = bricksNear(triangleOf(at, bounds.delta), bricks);
                }
            }
        }
    }
    const uint wanted = shares + bitCount(bits);
    const uint slot = wanted > 0 ? atomicAdd(parts, wanted) : 0;
    barrier();
    if (lane == 0 && parts > 0) {
        firstPart = reserve(VOXTACT_QUEUE_LARGE, parts, LARGE_ROOM, 1);
        if (firstPart + parts > LARGE_ROOM) {
            leave(VOXTACT_LEFT_GROUP, gl_WorkGroupID.x, 0, groupsIfLeft);
        }
    }
    barrier();
    // Where not all of the group's have room, none is there.
    const uint pair = firstPart + parts <= LARGE_ROOM ? own.pair : kNoPair;
    for (uint part = 0; part < wanted && firstPart + slot + part < LARGE_ROOM; ++part) {
        quads[quadOf(VOXTACT_WORD_LARGE(constants.queueRoom), firstPart + slot + part)] =
            uvec4(pair, own.number, shares > 0 ? part : uint(findLSB(bits)), shares);
        bits &= bits - 1;
    }
}
