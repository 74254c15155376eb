// SPDX-License-Identifier: MIT
// The projection `conservative` with a margin, the bricks near triangles: a work group has four runs, a lane each
// triangle. The bricks that may have something opaque within the margin of one go into the queue of large triangles, one
// an entry; a triangle that is near more than a lane looks at is left to certified_margin_finish. What is put twice does
// no harm: the answer is yes where one says so.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define MARGIN
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

/// Bricks that a lane looks at.
const int kMostBricks = 512;

shared uint groupsIfLeft; // of certified_margin_finish, for all of the work group
shared uint full;         // the queue is

/// Bricks that are too many for a lane; also where their number overflows.
bool areMany(CellBox bricks) {
    const ivec3 sides = bricks.hi - bricks.lo + 1;
    return any(greaterThan(sides, ivec3(kMostBricks))) || volumeOf(bricks) > kMostBricks;
}

/// Puts an entry into the queue of large triangles: one brick of a triangle, or all of it.
void putLarge(TriangleLane own, uint brick, bool all) {
    const uint entry = reserve(VOXTACT_QUEUE_LARGE, 1, LARGE_ROOM, 1);
    if (entry < LARGE_ROOM) {
        quads[quadOf(VOXTACT_WORD_LARGE(constants.queueRoom), entry)] = uvec4(own.pair, own.number, brick, all ? 1 : 0);
    } else {
        atomicOr(full, 1u);
    }
}

void putBricks(TriangleLane own, CertifiedTriangle triangle, CellBox bricks) {
    const int count = volumeOf(bricks);
    countWork(VOXTACT_WORK_BRICKS, uint(count));
    for (int i = 0; i < count; ++i) {
        if (marginBrickMay(triangle, placeIn(bricks, i))) {
            putLarge(own, uint(i), false);
        }
    }
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0) {
        groupsIfLeft = 0;
        full = 0;
    }
    barrier();
    const TriangleLane own = triangleLane(gl_WorkGroupID.x, lane);
    if (own.some) {
        const TriangleVertices at = verticesOf(transforms[own.pair], own.number);
        const CertifiedBounds bounds = boundsOf(at);
        const CellBox cells = cellsOf(bounds);
        if (!isEmpty(cells)) {
            // Those of pairs that are done, too: certified_margin_finish must find the same, and more will be done then.
            atomicAdd(groupsIfLeft, groupsOfTriangle(transforms[own.pair], bounds, cells));
            if (isDone(own.pair)) {
            } else if (!bounds.usable || areMany(bricksOf(cells))) {
                putLarge(own, 0, true);
            } else {
                putBricks(own, triangleOf(at, bounds.delta), bricksOf(cells));
            }
        }
    }
    barrier();
    if (lane == 0 && full != 0) {
        leave(VOXTACT_LEFT_GROUP, gl_WorkGroupID.x, 0, groupsIfLeft);
    }
}
