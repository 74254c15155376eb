// SPDX-License-Identifier: MIT
// Where clearances are measured: what all triangles of an entry say of a brick along one direction, by all lanes of
// certified_margin_large together. The shadow of triangles is no longer than that of the nearest of them: it says more
// of what is beside them than their common box. Expects certified_clearance_cell.glsl.
#ifndef VOXTACT_CERTIFIED_CLEARANCE_ALONG_GLSL
#define VOXTACT_CERTIFIED_CLEARANCE_ALONG_GLSL

shared uint nearestKey;                       // the least key of a triangle: how near it may be to the brick, and its lane
shared VoxelPoint way;                        // flat: from that triangle to what is nearest of the brick
shared float shadowOf[VOXTACT_RUN_TRIANGLES]; // of each triangle on it, about the brick's middle
const uint kNothing = 0x7f800000u;

struct AlongBrick {
    VoxelPoint along;  // flat
    VoxelPoint pulled; // to voxel space
    float shadow;      // of the triangles on it, about the brick's middle
    float square;
    float slack;
};

/// `some`: the lane has a triangle of the entry, whose triangles are all in `reach`.
AlongBrick findAlong(MarginSpace by, bool some, CertifiedTriangle triangle, CertifiedReach reach, vec3 centre) {
    const uint lane = gl_LocalInvocationIndex;
    const VoxelPoint middle = voxelPoint(centre.x, centre.y, centre.z);
    const float r = MARGIN_BRICK_RADIUS;
    if (lane == 0) {
        nearestKey = kNothing;
        way = voxelPoint(0.0, 0.0, 0.0);
    }
    barrier();
    MarginTriangle about;
    VoxelPoint own = voxelPoint(0.0, 0.0, 0.0);
    uint key = kNothing;
    if (some) {
        about = marginTriangle(by, triangle, middle, r);
        const MarginNear near = marginNear(by, about, own);
        // The lane in place of the last bits: no two are alike.
        key = floatBitsToUint(boxBelow(by, about, near, voxelPoint(r, r, r))) / VOXTACT_RUN_TRIANGLES *
                  VOXTACT_RUN_TRIANGLES + lane;
        const VoxelPoint to = voxelPoint(clamp(near.at.x, -r, r), clamp(near.at.y, -r, r), clamp(near.at.z, -r, r));
        own = marginFlat(by, voxelDifference(to, near.at));
        atomicMin(nearestKey, key);
    }
    barrier();
    if (some && key == nearestKey) {
        way = own;
    }
    barrier();
    AlongBrick found;
    found.along = way;
    found.pulled = marginPulled(by, way);
    found.square = voxelDot(way, way);
    if (lane < VOXTACT_RUN_TRIANGLES) {
        shadowOf[lane] = some ? max(voxelDot(found.pulled, about.a),
                                    max(voxelDot(found.pulled, about.b), voxelDot(found.pulled, about.c)))
                              : -3.0e38;
    }
    barrier();
    found.shadow = shadowOf[0];
    for (uint i = 1; i < VOXTACT_RUN_TRIANGLES; ++i) {
        found.shadow = max(found.shadow, shadowOf[i]);
    }
    const float farthest =
        max(voxelLength(voxelDifference(reach.lo, middle)), voxelLength(voxelDifference(reach.hi, middle))) + 2.0 * r;
    found.slack = 2.0 * marginSlack(by, reach.delta, farthest);
    return found;
}

/// What a cell, given by where its middle is from the brick's, is no nearer to the triangles than.
float cellAlong(AlongBrick by, vec3 from) {
    const float gap = voxelDot(by.pulled, voxelPoint(from.x, from.y, from.z)) +
                      marginBoxShadow(by.pulled, voxelPoint(0.5, 0.5, 0.5)) - by.shadow;
    return clearanceBelow(gap, by.square, by.slack);
}

/// The same of what may be opaque in it.
float partAlong(MarginSpace by, AlongBrick direction, CertifiedCell cell, vec3 corner) {
    const MarginBox box = marginCellBox(cell);
    const VoxelPoint middle = marginMiddle(box);
    const VoxelPoint radius = marginRadius(box);
    MarginNear near;
    near.at = middle;
    near.along = direction.along;
    near.shadow = direction.shadow - voxelDot(direction.pulled, voxelPoint(corner.x + middle.x, corner.y + middle.y,
                                                                           corner.z + middle.z));
    return clearanceBelow(marginPartGap(by, cell, marginCellValues(opacities(), cell, kFewSteps), near,
                                        marginLinear(cell, box), radius),
                          direction.square, direction.slack);
}

#endif
