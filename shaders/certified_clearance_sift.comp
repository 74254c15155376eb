// SPDX-License-Identifier: MIT
// Where clearances are measured, before cells are looked at: a lane an entry of the queue of large triangles that is
// near. What may be opaque in its brick is no nearer to its triangles than the shadows of both are to each other, on the
// way from the nearest triangle to the brick. Of the cells that certainly have something, the first on it bounds the
// distance above. Triangles that are farther from the brick than what is known are taken out of the entry.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define MARGIN
#define CLEARANCE
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"
#include "certified_clearance_cell.glsl"
#include "certified_clearance_bits.glsl"
#include "certified_clearance_way.glsl"

/// The triangles of an entry, and where they are.
struct Entry {
    CertifiedPair transform;
    uint firstTriangle; // of the run
    uint which;         // of it
    MarginSpace by;
    VoxelPoint middle; // of the brick
};

CertifiedTriangle placed(Entry entry, uint i) {
    const TriangleVertices at = verticesOf(entry.transform, triangleAt(entry.firstTriangle + i));
    return triangleOf(at, certifiedReach(at.voxel[0], at.voxel[1], at.voxel[2]).delta);
}

struct Nearest {
    CertifiedTriangle triangle;
    uint own;         // which of the run it is
    uint which;       // may be nearer to the box than what is known
    float below;      // none is nearer to the box
    VoxelPoint along; // flat: from the nearest to what is nearest of the box
};

/// Of a cube, given by its middle and half its side.
Nearest nearestTo(Entry entry, VoxelPoint middle, float radius) {
    Nearest found;
    found.own = 0;
    found.which = 0;
    found.below = VOXTACT_CLEARANCE_FAR;
    found.along = voxelPoint(0.0, 0.0, 0.0);
    found.triangle = certifiedTriangle(found.along, found.along, found.along, 0.0);
    for (uint i = 0; i < VOXTACT_RUN_TRIANGLES; ++i) {
        if ((entry.which >> i & 1u) == 0) {
            continue;
        }
        const CertifiedTriangle triangle = placed(entry, i);
        const MarginTriangle about = marginTriangle(entry.by, triangle, middle, radius);
        const MarginNear near = marginNear(entry.by, about, voxelPoint(0.0, 0.0, 0.0));
        const float below = boxBelow(entry.by, about, near, voxelPoint(radius, radius, radius));
        found.which |= below < entry.by.margin ? 1u << i : 0u;
        if (below < found.below) {
            found.below = below;
            found.triangle = triangle;
            found.own = i;
            found.along = marginFlat(entry.by, voxelDifference(voxelPoint(clamp(near.at.x, -radius, radius),
                                                                          clamp(near.at.y, -radius, radius),
                                                                          clamp(near.at.z, -radius, radius)),
                                                               near.at));
        }
    }
    return found;
}

/// The shadow of the triangles, about the brick's middle, and by how much a distance along it may be off.
struct Shadow {
    float most;
    float slack;
};

Shadow shadowOf(Entry entry, VoxelPoint pulled) {
    Shadow shadow = Shadow(-3.0e38, 0.0);
    for (uint i = 0; i < VOXTACT_RUN_TRIANGLES; ++i) {
        if ((entry.which >> i & 1u) != 0) {
            const MarginTriangle about =
                marginTriangle(entry.by, placed(entry, i), entry.middle, 2.0 * MARGIN_BRICK_RADIUS);
            shadow.most = max(max(shadow.most, voxelDot(pulled, about.a)),
                              max(voxelDot(pulled, about.b), voxelDot(pulled, about.c)));
            shadow.slack = max(shadow.slack, 2.0 * about.slack);
        }
    }
    return shadow;
}

void main() {
    if (gl_GlobalInvocationID.x >= queueCount(VOXTACT_QUEUE_NEAR)) {
        return;
    }
    const uint at = quadOf(LARGE_WORD, queues[nearWord(gl_GlobalInvocationID.x)]);
    const uvec4 entry = quads[at];
    if ((entry.w & VOXTACT_MARGIN_ALL) != 0 || isDone(entry.x)) {
        return;
    }
    const ivec3 brick = brickOf(int(brickOfEntry(entry.z)));
    const ivec3 corner = (brick << VOXTACT_BRICK_SHIFT) - 1;
    const vec3 centre = brickCentre(brick);
    Entry own = Entry(transforms[entry.x], entry.y * VOXTACT_RUN_TRIANGLES, entry.w, clearanceSpace(entry.x),
                      voxelPoint(centre.x, centre.y, centre.z));
    const Nearest nearest = nearestTo(own, own.middle, MARGIN_BRICK_RADIUS);
    own.which = nearest.which;
    const VoxelPoint pulled = marginPulled(own.by, nearest.along);
    const Shadow shadow = shadowOf(own, pulled);
    const First first = firstOnWay(entry.z, pulled);
    const float below =
        max(nearest.below,
            clearanceBelow(first.least - shadow.most, voxelDot(nearest.along, nearest.along), shadow.slack));
    const CellClearance nearestHas = cellClearance(own.by, nearest.triangle, first.has < 0 ? 0 : MARGIN_HAS_SOME,
                                                   corner + cellInBrick(uint(max(first.has, 0))));
    if (isCut()) {
        return; // of which nothing is known
    }
    if ((entry.z & VOXTACT_HAS_SLOT) != 0) {
        quads[at].z = VOXTACT_HAS_SLOT | slotOf(entry.z) | uint(max(first.may, 0)) << VOXTACT_FIRST_CELL_SHIFT |
                      nearest.own << VOXTACT_FIRST_TRIANGLE_SHIFT;
    }
    quads[at].w = withBelow(entry.x, own.which & VOXTACT_MARGIN_ALL - 1, below);
    if (nearestHas.above < clearanceHi(entry.x)) {
        foundAt(entry.x, triangleAt(own.firstTriangle + nearest.own), nearestHas.above, nearestHas.place);
    }
}
