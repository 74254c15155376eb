// SPDX-License-Identifier: MIT
// The projection `conservative` with a margin: how far a triangle is from a box of voxel space, in the world. One text
// for GLSL and C++, so that device and host say the same.
//
// Voxel space is not the world: its axes may be of different lengths and at any angles. *Flat* space is the world
// turned so that its first axis is along the grid's first, and its second in the plane of the grid's first two: from
// voxel space a triangular matrix leads there. Distances are those of the world in units of the longest side of a
// voxel.
//
// Whatever the direction y, two bodies are as far apart as the gap between their shadows on it, over the length of y:
// so a direction need not be the best one for what follows from it to be true. Gaps are compared as squares; nothing is
// divided, and no root taken, in what decides.
#ifndef VOXTACT_CERTIFIED_MARGIN_H
#define VOXTACT_CERTIFIED_MARGIN_H

#include "certified.h"

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
    return by;
}

EXACT float voxelDot(VoxelPoint a, VoxelPoint b) {
    PRECISE float sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
}

/// a + b * weight.
EXACT VoxelPoint voxelStep(VoxelPoint a, VoxelPoint b, float weight) {
    PRECISE float x = a.x + b.x * weight;
    PRECISE float y = a.y + b.y * weight;
    PRECISE float z = a.z + b.z * weight;
    return voxelPoint(x, y, z);
}

EXACT VoxelPoint voxelCross(VoxelPoint a, VoxelPoint b) {
    PRECISE float x = a.y * b.z - a.z * b.y;
    PRECISE float y = a.z * b.x - a.x * b.z;
    PRECISE float z = a.x * b.y - a.y * b.x;
    return voxelPoint(x, y, z);
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

/// The cells within the margin of what `reach` says of a triangle or a box.
EXACT CertifiedBounds marginBounds(CertifiedItem item, MarginSpace by, CertifiedReach reach) {
    CertifiedBounds bounds;
    bounds.delta = reach.delta;
    bounds.usable = reach.delta <= CERTIFIED_MOST_DELTA;
    PRECISE float x = reach.delta + by.grow.x;
    PRECISE float y = reach.delta + by.grow.y;
    PRECISE float z = reach.delta + by.grow.z;
    certifiedCells(reach.lo.x, reach.hi.x, x, item.sizeX, bounds.firstX, bounds.lastX);
    certifiedCells(reach.lo.y, reach.hi.y, y, item.sizeY, bounds.firstY, bounds.lastY);
    certifiedCells(reach.lo.z, reach.hi.z, z, item.sizeZ, bounds.firstZ, bounds.lastZ);
    return bounds;
}

/// What two of them say of both.
EXACT CertifiedReach marginUnion(CertifiedReach a, CertifiedReach b) {
    CertifiedReach both;
    both.lo = voxelPoint(certifiedMin(a.lo.x, b.lo.x), certifiedMin(a.lo.y, b.lo.y), certifiedMin(a.lo.z, b.lo.z));
    both.hi = voxelPoint(certifiedMax(a.hi.x, b.hi.x), certifiedMax(a.hi.y, b.hi.y), certifiedMax(a.hi.z, b.hi.z));
    both.delta = certifiedMax(a.delta, b.delta);
    return both;
}

/// A triangle about some point: where a box of voxel space is looked at.
struct MarginTriangle {
    VoxelPoint a, b, c;
    float slack; // flat: of distances from it to points of the box
};

/// `reach`: of the box's coordinates, about `origin`, the largest.
EXACT MarginTriangle marginTriangle(MarginSpace by, CertifiedTriangle triangle, VoxelPoint origin, float reach) {
    MarginTriangle about;
    about.a = voxelDifference(triangle.corner0, origin);
    about.b = voxelDifference(triangle.corner1, origin);
    about.c = voxelDifference(triangle.corner2, origin);
    PRECISE float farthest =
        certifiedMax(voxelLength(about.a), certifiedMax(voxelLength(about.b), voxelLength(about.c))) + reach;
    about.slack = marginSlack(by, triangle.delta, farthest);
    return about;
}

/// What is nearest to a point in a triangle, or about that.
struct MarginNear {
    VoxelPoint at;    // a point of the triangle, whatever rounding did
    VoxelPoint along; // flat: the direction from there, of no particular length
    float shadow;     // of the triangle on it, about the point: the greatest
};

/// 1 / value, and 0 for what is too small to be divided by.
EXACT float marginInverse(float value) {
    return value > 1.0e-30f && value < 1.0e30f ? exactReciprocal(value) : 0.0f;
}

EXACT MarginNear marginNear(MarginSpace by, MarginTriangle triangle, VoxelPoint from) {
    const VoxelPoint voxels[3] = {triangle.a, triangle.b, triangle.c};
    VoxelPoint corners[3];
    for (int i = 0; i < 3; ++i) {
        corners[i] = marginFlat(by, voxelDifference(voxels[i], from));
    }
    MarginNear near;
    near.at = triangle.a;
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
        near.at = voxelStep(voxelStep(triangle.a, voxelDifference(triangle.b, triangle.a), second),
                            voxelDifference(triangle.c, triangle.a), third);
    }
    near.along = voxelPoint(-near.along.x, -near.along.y, -near.along.z);
    near.shadow = certifiedMax(voxelDot(near.along, corners[0]),
                               certifiedMax(voxelDot(near.along, corners[1]), voxelDot(near.along, corners[2])));
    return near;
}

/// Whether a gap between shadows on a direction whose square is `square` proves that what they are of is farther apart
/// than the margin.
EXACT bool marginBeyond(MarginSpace by, float slack, float gap, float square) {
    PRECISE float most = (by.margin + slack) * MARGIN_OUTWARD;
    PRECISE float reached = most * most * square * MARGIN_OUTWARD;
    PRECISE float gapSquare = gap * gap;
    return square >= MARGIN_LEAST_SQUARE && gap > 0.0f && gapSquare > reached;
}

/// Whether a point is certainly within the margin of a triangle that has the point `near`.
EXACT bool marginWithin(MarginSpace by, float slack, VoxelPoint near, VoxelPoint at) {
    const VoxelPoint way = marginFlat(by, voxelDifference(at, near));
    PRECISE float most = by.margin * MARGIN_INWARD - slack;
    PRECISE float square = most * most * MARGIN_INWARD;
    return most > 0.0f && voxelDot(way, way) <= square;
}

/// The least that a direction says of a box: `pulled` is the direction, about the box's middle.
EXACT float marginBoxShadow(VoxelPoint pulled, VoxelPoint radius) {
    PRECISE float least =
        -(certifiedAbs(pulled.x) * radius.x + certifiedAbs(pulled.y) * radius.y + certifiedAbs(pulled.z) * radius.z);
    return least;
}

/// Whether a box is certainly farther from the triangle than the margin. `near` is what is nearest to its middle.
EXACT bool marginBoxBeyond(MarginSpace by, MarginTriangle triangle, MarginNear near, VoxelPoint radius) {
    PRECISE float gap = marginBoxShadow(marginPulled(by, near.along), radius) - near.shadow;
    return marginBeyond(by, triangle.slack, gap, voxelDot(near.along, near.along));
}

/// The same for what is dropped at once (MARGIN_FARTHER): a box given by its middle and half its sides.
EXACT bool marginBoxFarther(MarginSpace by, CertifiedTriangle triangle, VoxelPoint middle, VoxelPoint radius) {
    MarginTriangle about = marginTriangle(by, triangle, middle, voxelLength(radius));
    PRECISE float slack = about.slack + about.slack + MARGIN_FARTHER;
    about.slack = slack;
    return marginBoxBeyond(by, about, marginNear(by, about, voxelPoint(0.0f, 0.0f, 0.0f)), radius);
}

/// How far a box is beyond what `lo` and `hi` are the ends of, along one axis; negative where it is on the other side.
EXACT float marginApart(float lo, float hi, float middle, float radius) {
    PRECISE float after = middle - radius - hi;
    PRECISE float before = lo - (middle + radius);
    return after > 0.0f ? after : before > 0.0f ? -before : 0.0f;
}

/// What an axis adds to the gap between the shadows of the two, of which a direction has the component `along` there.
EXACT float marginGap(float along, float lo, float hi, float middle, float radius) {
    PRECISE float after = along * (middle - radius - hi);
    PRECISE float before = along * (middle + radius - lo);
    return along < 0.0f ? before : after;
}

/// A gap between the shadows of two bodies on a direction.
struct MarginApart {
    float gap;
    float square; // of the direction
    float slack;  // flat
};

/// Of a box, and of all that `reach` says triangles are in.
EXACT MarginApart marginReachApart(MarginSpace by, CertifiedReach reach, VoxelPoint middle, VoxelPoint radius) {
    const VoxelPoint apart = voxelPoint(marginApart(reach.lo.x, reach.hi.x, middle.x, radius.x),
                                        marginApart(reach.lo.y, reach.hi.y, middle.y, radius.y),
                                        marginApart(reach.lo.z, reach.hi.z, middle.z, radius.z));
    const VoxelPoint along = marginFlat(by, apart);
    const VoxelPoint pulled = marginPulled(by, along);
    PRECISE float gap = marginGap(pulled.x, reach.lo.x, reach.hi.x, middle.x, radius.x) +
                        marginGap(pulled.y, reach.lo.y, reach.hi.y, middle.y, radius.y) +
                        marginGap(pulled.z, reach.lo.z, reach.hi.z, middle.z, radius.z);
    PRECISE float farthest =
        certifiedMax(voxelLength(voxelDifference(reach.lo, middle)), voxelLength(voxelDifference(reach.hi, middle))) +
        voxelLength(radius);
    MarginApart found;
    found.gap = gap;
    found.square = voxelDot(along, along);
    found.slack = marginSlack(by, reach.delta, farthest);
    return found;
}

/// Whether all that `reach` says triangles are in is certainly farther from a box than the margin (MARGIN_FARTHER).
EXACT bool marginReachFarther(MarginSpace by, CertifiedReach reach, VoxelPoint middle, VoxelPoint radius) {
    const MarginApart apart = marginReachApart(by, reach, middle, radius);
    PRECISE float slack = apart.slack * 2.0f + MARGIN_FARTHER;
    return marginBeyond(by, slack, apart.gap, apart.square);
}

/// marginBoxBeyond() of a cube, given by its middle and half its side.
EXACT bool marginCubeBeyond(MarginSpace by, CertifiedTriangle triangle, VoxelPoint middle, float radius) {
    const MarginTriangle about = marginTriangle(by, triangle, middle, radius);
    const VoxelPoint none = voxelPoint(0.0f, 0.0f, 0.0f);
    return marginBoxBeyond(by, about, marginNear(by, about, none), voxelPoint(radius, radius, radius));
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
