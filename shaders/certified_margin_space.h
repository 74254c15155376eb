// SPDX-License-Identifier: MIT
// The space that a margin is measured in, flat space (certified_margin.h), and what is nearest to a point in a triangle
// there. One text for GLSL and C++.
#ifndef VOXTACT_CERTIFIED_MARGIN_SPACE_H
#define VOXTACT_CERTIFIED_MARGIN_SPACE_H

#include "certified.h"
#include "certified_move.h"
#include "certified_turn.h"

/// Of the largest coordinate from where things are measured, in voxels: more than rounding moves a point, a shadow or a
/// point of a triangle by. The sums have 3 terms and some 16 roundings of 2^-24 one after the other.
#define MARGIN_ROUNDING 3.814697265625e-6f
/// More than the roundings of two squares that are compared.
#define MARGIN_OUTWARD 1.0000038146972656f
#define MARGIN_INWARD 0.9999961853027344f
/// The square of the least length of a direction that says something: smaller squares may be taken for zero.
#define MARGIN_LEAST_SQUARE 1.0e-18f
/// By how much more than the margin, flat, a box is away that is dropped for several triangles at once, or that holds
/// several cells. It is more than the half diagonal of the least box that a cell is halved into: so a decision of each
/// cell of each triangle drops the same, and no answer depends on what was put together.
#define MARGIN_FARTHER 0.015625f

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

/// What a margin needs of an item. In the words that `scale` and `resolution` of CertifiedItem have without one.
struct MarginSpace {
    float xx, xy, xz, yy, yz, zz; // flat space from voxel space
    VoxelPoint grow;              // voxels along each axis that the margin reaches, rounded up
    float margin;                 // flat
    float size;                   // of the matrix: no vector becomes longer than that times its largest component
    VoxelPoint pivot;             // with TURN or MOVE, what it turns about. Then `grow` is that of a margin of 1, flat
#ifdef TURN
    float pivotError; // voxels, along each axis
    TurnLimit turn;
#endif
#ifdef MOVE
    MoveWay move;
    float leastSide; // flat: a box of a cell is not halved where it is no longer
#endif
};

EXACT MarginSpace marginOf(CertifiedItem item) {
    MarginSpace by;
    by.xx = item.scale[0];
    by.xy = item.scale[1];
    by.xz = item.scale[2];
    by.yy = item.scale[3];
    by.yz = item.scale[4];
    by.zz = item.scale[5];
    by.grow = voxelPoint(item.scale[6], item.scale[7], item.scale[8]);
    by.margin = item.resolution;
    PRECISE float x = certifiedAbs(by.xx) + certifiedAbs(by.xy) + certifiedAbs(by.xz);
    PRECISE float yz = certifiedAbs(by.yy) + certifiedAbs(by.yz) + certifiedAbs(by.zz);
    PRECISE float size = x + yz;
    by.size = size;
    by.pivot = voxelPoint(0.0f, 0.0f, 0.0f);
    return by;
}

/// A vector of voxel space in flat space.
EXACT VoxelPoint marginFlat(MarginSpace by, VoxelPoint v) {
    PRECISE float x = by.xx * v.x + by.xy * v.y + by.xz * v.z;
    PRECISE float y = by.yy * v.y + by.yz * v.z;
    PRECISE float z = by.zz * v.z;
    return voxelPoint(x, y, z);
}

/// The components of a direction of flat space along the axes of voxel space: what it says of vectors there.
EXACT VoxelPoint marginPulled(MarginSpace by, VoxelPoint y) {
    PRECISE float first = by.xx * y.x;
    PRECISE float second = by.xy * y.x + by.yy * y.y;
    PRECISE float third = by.xz * y.x + by.yz * y.y + by.zz * y.z;
    return voxelPoint(first, second, third);
}

/// By how much a distance may be off, flat: the places of a triangle by `delta` along each axis, and rounding, `reach`
/// being the largest coordinate that is computed with.
EXACT float marginSlack(MarginSpace by, float delta, float reach) {
    PRECISE float slack = by.size * (delta + reach * MARGIN_ROUNDING);
    return slack;
}

#if defined(TURN) || defined(MOVE)
/// No vector of voxel space whose components are no larger is longer, flat.
EXACT float marginLongest(MarginSpace by, VoxelPoint most) {
    PRECISE float x = certifiedAbs(by.xx) * most.x + certifiedAbs(by.xy) * most.y + certifiedAbs(by.xz) * most.z;
    PRECISE float y = certifiedAbs(by.yy) * most.y + certifiedAbs(by.yz) * most.z;
    PRECISE float z = certifiedAbs(by.zz) * most.z;
    return turnLength(voxelPoint(x, y, z));
}
#endif

/// A triangle about some point: where a box of voxel space is looked at.
struct MarginTriangle {
    VoxelPoint a, b, c;
    VoxelPoint pivot; // with TURN
    float slack;      // flat: of distances from it to points of the box
#ifdef TURN
    VoxelPoint rim[4]; // flat: corners of a rectangle around what of it a turn may bring to the box
#endif
};

/// What is nearest to a point in a triangle, or about that.
struct MarginNear {
    VoxelPoint at;    // a point of the triangle, whatever rounding did
    VoxelPoint moved; // where it gets: with TURN, turned towards the other; else the same
    VoxelPoint along; // flat: the direction from there, of no particular length
    float shadow;     // of the triangle on it, about the point: the greatest
};

/// 1 / value, and 0 for what is too small to be divided by.
EXACT float marginInverse(float value) {
    return value > 1.0e-30f && value < 1.0e30f ? exactReciprocal(value) : 0.0f;
}

/// What is nearest to the origin of `corners`, which are flat, in the triangle that has the corners `voxels`; `along`
/// is not the direction from there, but to there.
EXACT MarginNear marginNearest(ARRAY(VoxelPoint, voxels, 3), ARRAY(VoxelPoint, corners, 3)) {
    MarginNear near;
    near.at = voxels[0];
    near.along = corners[0];
    float least = 3.0e38f;
    for (int i = 0; i < 3; ++i) {
        const int after = i == 2 ? 0 : i + 1;
        const VoxelPoint edge = voxelDifference(corners[after], corners[i]);
        const float inverse = marginInverse(voxelDot(edge, edge));
        PRECISE float weight = -voxelDot(corners[i], edge) * inverse;
        weight = certifiedClamp(weight, 0.0f, 1.0f);
        VoxelPoint nearest = voxelStep(corners[i], edge, weight);
        const float square = voxelDot(nearest, nearest);
        if (square < least) {
            least = square;
            near.at = voxelStep(voxels[i], voxelDifference(voxels[after], voxels[i]), weight);
            if (weight > 0.0f && weight < 1.0f) {
                // At right angles to the edge, more closely: a long edge has a long shadow.
                PRECISE float less = -voxelDot(nearest, edge) * inverse;
                nearest = voxelStep(nearest, edge, less);
            }
            near.along = nearest;
        }
    }
    const VoxelPoint u = voxelDifference(corners[1], corners[0]);
    const VoxelPoint v = voxelDifference(corners[2], corners[0]);
    const VoxelPoint normal = voxelCross(u, v);
    const float inverse = marginInverse(voxelDot(normal, normal));
    PRECISE float second = voxelDot(voxelCross(v, corners[0]), normal) * inverse;
    PRECISE float third = voxelDot(voxelCross(corners[0], u), normal) * inverse;
    if (inverse > 0.0f && second >= 0.0f && third >= 0.0f && second + third <= 1.0f) {
        PRECISE float height = voxelDot(normal, corners[0]) * inverse;
        near.along = voxelStep(voxelPoint(0.0f, 0.0f, 0.0f), normal, height);
        near.at = voxelStep(voxelStep(voxels[0], voxelDifference(voxels[1], voxels[0]), second),
                            voxelDifference(voxels[2], voxels[0]), third);
    }
    near.moved = near.at;
    near.shadow = 0.0f;
    return near;
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
