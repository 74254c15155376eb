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
//
// With TURN the mesh may also be turned, about a point and by no more than an angle: its shadow is longer by what
// certified_turn.h says, corner by corner, and what it is within the margin of is turned towards it first. With MOVE it
// goes a piece of its way, as certified_move.h says: its shadow is longer by that.
#ifndef VOXTACT_CERTIFIED_MARGIN_H
#define VOXTACT_CERTIFIED_MARGIN_H

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

#if defined(TURN)
/// The same, of what turns about `pivot`: by what that is off, a place that is turned is off by no more than twice, and
/// rounding is of arms from there, too.
EXACT float marginMovedSlack(MarginSpace by, VoxelPoint pivot, float delta, float reach) {
    PRECISE float off = delta + by.pivotError * 2.0f;
    PRECISE float farthest = (voxelLength(pivot) + reach) * 2.0f + reach;
    return marginSlack(by, off, farthest);
}

/// Voxels along each axis that the margin and a turn reach from all that is in a box.
EXACT VoxelPoint marginGrow(MarginSpace by, CertifiedReach reach) {
    const VoxelPoint arm = voxelPoint(certifiedFarther(reach.lo.x, reach.hi.x, by.pivot.x),
                                      certifiedFarther(reach.lo.y, reach.hi.y, by.pivot.y),
                                      certifiedFarther(reach.lo.z, reach.hi.z, by.pivot.z));
    const float slack = marginMovedSlack(by, by.pivot, reach.delta, voxelLength(arm));
    PRECISE float most = by.margin + (marginLongest(by, arm) + slack) * by.turn.chord + slack;
    PRECISE float outward = most * MARGIN_OUTWARD;
    return voxelStep(voxelPoint(0.0f, 0.0f, 0.0f), by.grow, outward);
}

/// The way to a point from what is `near` it, which is turned towards it first. Flat.
EXACT VoxelPoint marginWay(MarginSpace by, VoxelPoint pivot, VoxelPoint near, VoxelPoint at) {
    const VoxelPoint wanted = marginFlat(by, voxelDifference(at, pivot));
    const VoxelPoint arm = marginFlat(by, voxelDifference(near, pivot));
    return voxelDifference(wanted, turnTowards(by.turn, arm, wanted));
}
#elif defined(MOVE)
/// The same, of what goes a piece of its way, `pivot` being the centre: twice what moves are off by, as these bend.
EXACT float marginMovedSlack(MarginSpace by, VoxelPoint pivot, float delta, float reach) {
    PRECISE float off = delta + voxelLength(moveSpread(by.move, voxelPoint(delta, delta, delta))) * 2.0f;
    PRECISE float farthest = reach + moveReach(by.move, voxelLength(pivot) + reach) * 2.0f;
    return marginSlack(by, off, farthest);
}

/// The move of what is at a place of voxel space, the greatest components of one in a box about it of such half sides,
/// and no less than the flat length of what of any such move is of turning.
struct MarginMove {
    VoxelPoint move;
    VoxelPoint most;
    float turning;
};

EXACT VoxelPoint marginMost(VoxelPoint middle, VoxelPoint spread) {
    PRECISE float x = certifiedAbs(middle.x) + spread.x;
    PRECISE float y = certifiedAbs(middle.y) + spread.y;
    PRECISE float z = certifiedAbs(middle.z) + spread.z;
    return voxelPoint(x, y, z);
}

EXACT MarginMove marginMoveAbout(MarginSpace by, VoxelPoint middle, VoxelPoint radius) {
    const VoxelPoint spread = moveSpread(by.move, radius);
    MarginMove found;
    found.move = moveOf(by.move, voxelDifference(middle, by.pivot));
    found.most = marginMost(found.move, spread);
    found.turning = marginLongest(by, marginMost(voxelDifference(found.move, by.move.straight), spread));
    return found;
}

/// Voxels along each axis that all that is in a box may get to.
EXACT VoxelPoint marginGrow(MarginSpace by, CertifiedReach reach) {
    const VoxelPoint middle = voxelStep(reach.lo, voxelDifference(reach.hi, reach.lo), 0.5f);
    const VoxelPoint radius = voxelDifference(reach.hi, middle);
    const MarginMove all = marginMoveAbout(by, middle, radius);
    const VoxelPoint arm = marginMost(voxelDifference(middle, by.pivot), radius);
    const float slack = marginMovedSlack(by, by.pivot, reach.delta, voxelLength(arm));
    PRECISE float most = (all.turning * by.move.bend + by.margin + slack) * MARGIN_OUTWARD;
    return voxelStep(voxelStep(voxelPoint(0.0f, 0.0f, 0.0f), all.most, MARGIN_OUTWARD), by.grow, most);
}
#else
EXACT float marginMovedSlack(MarginSpace by, VoxelPoint, float delta, float reach) {
    return marginSlack(by, delta, reach);
}

EXACT VoxelPoint marginGrow(MarginSpace by, CertifiedReach) {
    return by.grow;
}

EXACT VoxelPoint marginWay(MarginSpace by, VoxelPoint, VoxelPoint near, VoxelPoint at) {
    return marginFlat(by, voxelDifference(at, near));
}
#endif

/// The cells within the margin of what `reach` says of a triangle or a box.
EXACT CertifiedBounds marginBounds(CertifiedItem item, MarginSpace by, CertifiedReach reach) {
    CertifiedBounds bounds;
    bounds.delta = reach.delta;
    bounds.usable = reach.delta <= CERTIFIED_MOST_DELTA;
    const VoxelPoint grow = marginGrow(by, reach);
    PRECISE float x = reach.delta + grow.x;
    PRECISE float y = reach.delta + grow.y;
    PRECISE float z = reach.delta + grow.z;
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
    VoxelPoint pivot; // with TURN
    float slack;      // flat: of distances from it to points of the box
};

/// `reach`: of the box's coordinates, about `origin`, the largest.
EXACT MarginTriangle marginTriangle(MarginSpace by, CertifiedTriangle triangle, VoxelPoint origin, float reach) {
    MarginTriangle about;
    about.a = voxelDifference(triangle.corner0, origin);
    about.b = voxelDifference(triangle.corner1, origin);
    about.c = voxelDifference(triangle.corner2, origin);
    PRECISE float farthest =
        certifiedMax(voxelLength(about.a), certifiedMax(voxelLength(about.b), voxelLength(about.c))) + reach;
    about.pivot = voxelDifference(by.pivot, origin);
    about.slack = marginMovedSlack(by, about.pivot, triangle.delta, farthest);
    return about;
}

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

#if defined(TURN)
/// A vector of flat space in voxel space.
EXACT VoxelPoint marginUnflat(MarginSpace by, VoxelPoint v) {
    PRECISE float z = v.z * marginInverse(by.zz);
    PRECISE float y = (v.y - by.yz * z) * marginInverse(by.yy);
    PRECISE float x = (v.x - by.xy * y - by.xz * z) * marginInverse(by.xx);
    return voxelPoint(x, y, z);
}

/// Of the way from the nearest point to the triangle's middle: where a turn of it would bring that which does not turn
/// itself.
#define MARGIN_BEFORE_MIDDLE 0.015625f

/// Turned to where its nearest point gets nearest, another point of the triangle is: it is found by turning the other
/// one back. From there it is turned once more.
EXACT MarginNear marginNear(MarginSpace by, MarginTriangle triangle, VoxelPoint from) {
    VoxelPoint voxels[3] = {triangle.a, triangle.b, triangle.c};
    VoxelPoint corners[3];
    VoxelPoint shifted[3];
    for (int i = 0; i < 3; ++i) {
        corners[i] = marginFlat(by, voxelDifference(voxels[i], from));
        shifted[i] = corners[i];
    }
    const VoxelPoint wanted = marginFlat(by, voxelDifference(from, triangle.pivot));
    const VoxelPoint twoCorners = voxelStep(corners[0], corners[1], 1.0f);
    const VoxelPoint middle = voxelStep(voxelStep(wanted, twoCorners, 0.333333f), corners[2], 0.333333f);
    MarginNear near;
    VoxelPoint arm = wanted;
    for (int turn = 0; turn < 2; ++turn) {
        near = marginNearest(voxels, shifted);
        arm = marginFlat(by, voxelDifference(near.at, triangle.pivot));
        const VoxelPoint before = voxelStep(arm, voxelDifference(middle, arm), MARGIN_BEFORE_MIDDLE);
        const VoxelPoint less = voxelDifference(turnTowards(by.turn, wanted, before), wanted);
        for (int i = 0; i < 3; ++i) {
            shifted[i] = voxelDifference(corners[i], less);
        }
    }
    near.along = voxelDifference(wanted, turnTowards(by.turn, arm, wanted));
    const VoxelPoint back = marginUnflat(by, near.along);
    near.moved = voxelDifference(from, back);
    near.shadow = -3.0e38f;
    for (int i = 0; i < 3; ++i) {
        const VoxelPoint own = marginFlat(by, voxelDifference(voxels[i], triangle.pivot));
        PRECISE float shadow = voxelDot(near.along, corners[i]) + turnSurplus(by.turn, near.along, own);
        near.shadow = certifiedMax(near.shadow, shadow);
    }
    return near;
}
#elif defined(MOVE)
/// How far on a move what is to go `way` gets the closest: from -1 to 1.
EXACT float marginShare(VoxelPoint way, VoxelPoint move) {
    PRECISE float share = voxelDot(way, move) * marginInverse(voxelDot(move, move));
    return certifiedClamp(share, -1.0f, 1.0f);
}

/// What is nearest to the origin where each corner has gone a share of its move.
EXACT MarginNear marginNearAt(ARRAY(VoxelPoint, voxels, 3), ARRAY(VoxelPoint, corners, 3), ARRAY(VoxelPoint, moves, 3),
                              float share) {
    VoxelPoint shifted[3];
    for (int i = 0; i < 3; ++i) {
        shifted[i] = voxelStep(corners[i], moves[i], share);
    }
    return marginNearest(voxels, shifted);
}

/// The greatest shadow of the triangle on a direction, wherever on the piece it is.
EXACT float marginMoveShadow(MarginSpace by, VoxelPoint along, ARRAY(VoxelPoint, corners, 3),
                             ARRAY(VoxelPoint, moves, 3)) {
    PRECISE float bend = turnLength(along) * by.move.bend * MARGIN_OUTWARD;
    const VoxelPoint straight = marginFlat(by, by.move.straight);
    float most = -3.0e38f;
    for (int i = 0; i < 3; ++i) {
        const float way = voxelDot(along, moves[i]);
        const float turning = turnLength(voxelDifference(moves[i], straight));
        PRECISE float shadow = voxelDot(along, corners[i]) + certifiedAbs(way) + bend * turning;
        most = certifiedMax(most, shadow);
    }
    return most;
}

/// Of the corners `voxels` of a triangle, flat: where they are, from `from`, and how far each goes.
EXACT void marginMoves(MarginSpace by, MarginTriangle triangle, VoxelPoint from, ARRAY(VoxelPoint, voxels, 3),
                       ARRAY(VoxelPoint, corners, 3), ARRAY(VoxelPoint, moves, 3)) {
    for (int i = 0; i < 3; ++i) {
        corners[i] = marginFlat(by, voxelDifference(voxels[i], from));
        moves[i] = marginFlat(by, moveOf(by.move, voxelDifference(voxels[i], triangle.pivot)));
    }
}

/// Where the triangle's nearest point gets nearest, another point of it is nearest: it is looked for twice.
EXACT MarginNear marginNear(MarginSpace by, MarginTriangle triangle, VoxelPoint from) {
    VoxelPoint voxels[3] = {triangle.a, triangle.b, triangle.c};
    VoxelPoint corners[3];
    VoxelPoint moves[3];
    marginMoves(by, triangle, from, voxels, corners, moves);
    const VoxelPoint place = voxelStep(voxelStep(corners[0], corners[1], 1.0f), corners[2], 1.0f);
    const VoxelPoint sum = voxelStep(voxelStep(moves[0], moves[1], 1.0f), moves[2], 1.0f);
    const MarginNear first = marginNearAt(voxels, corners, moves, -marginShare(place, sum));
    const VoxelPoint way = moveOf(by.move, voxelDifference(first.at, triangle.pivot));
    const float share = -marginShare(marginFlat(by, voxelDifference(first.at, from)), marginFlat(by, way));
    const MarginNear second = marginNearAt(voxels, corners, moves, share);
    MarginNear near;
    near.at = second.at;
    near.moved = voxelStep(second.at, moveOf(by.move, voxelDifference(second.at, triangle.pivot)), share);
    near.along = voxelPoint(-second.along.x, -second.along.y, -second.along.z);
    near.shadow = marginMoveShadow(by, near.along, corners, moves);
    return near;
}

/// The same about a direction that is given.
EXACT MarginNear marginAlong(MarginSpace by, MarginTriangle triangle, VoxelPoint from, VoxelPoint along) {
    VoxelPoint voxels[3] = {triangle.a, triangle.b, triangle.c};
    VoxelPoint corners[3];
    VoxelPoint moves[3];
    marginMoves(by, triangle, from, voxels, corners, moves);
    MarginNear near;
    near.at = from;
    near.moved = from;
    near.along = along;
    near.shadow = marginMoveShadow(by, along, corners, moves);
    return near;
}
#else
EXACT MarginNear marginNear(MarginSpace by, MarginTriangle triangle, VoxelPoint from) {
    VoxelPoint voxels[3] = {triangle.a, triangle.b, triangle.c};
    VoxelPoint corners[3];
    for (int i = 0; i < 3; ++i) {
        corners[i] = marginFlat(by, voxelDifference(voxels[i], from));
    }
    MarginNear near = marginNearest(voxels, corners);
    near.along = voxelPoint(-near.along.x, -near.along.y, -near.along.z);
    near.shadow = certifiedMax(voxelDot(near.along, corners[0]),
                               certifiedMax(voxelDot(near.along, corners[1]), voxelDot(near.along, corners[2])));
    return near;
}
#endif

/// Whether a gap between shadows on a direction whose square is `square` proves that what they are of is farther apart
/// than the margin.
EXACT bool marginBeyond(MarginSpace by, float slack, float gap, float square) {
    PRECISE float most = (by.margin + slack) * MARGIN_OUTWARD;
    PRECISE float reached = most * most * square * MARGIN_OUTWARD;
    PRECISE float gapSquare = gap * gap;
    return square >= MARGIN_LEAST_SQUARE && gap > 0.0f && gapSquare > reached;
}

#ifndef MOVE
/// Whether a point is certainly within the margin of a triangle that has the point `near`; with TURN, of that turned
/// towards it about `pivot`.
EXACT bool marginWithin(MarginSpace by, VoxelPoint pivot, float slack, VoxelPoint near, VoxelPoint at) {
    const VoxelPoint way = marginWay(by, pivot, near, at);
    PRECISE float most = by.margin * MARGIN_INWARD - slack;
    PRECISE float square = most * most * MARGIN_INWARD;
    return most > 0.0f && voxelDot(way, way) <= square;
}
#endif

#ifdef TURN
/// Whether a move within the margin certainly brings what is turned, of `near` about `from`, into a box, although a
/// distance may be off by `slack`: once for where it is, and once for how far it moves. The margin may be 0.
EXACT bool marginInto(MarginSpace by, float slack, MarginNear near, VoxelPoint from, VoxelPoint lo, VoxelPoint hi) {
    const VoxelPoint least = voxelStep(lo, by.grow, slack * 2.0f);
    const VoxelPoint most = voxelStep(hi, by.grow, -slack * 2.0f);
    const VoxelPoint place =
        voxelPoint(certifiedClamp(near.moved.x, least.x, most.x), certifiedClamp(near.moved.y, least.y, most.y),
                   certifiedClamp(near.moved.z, least.z, most.z));
    const VoxelPoint way = voxelStep(near.along, marginFlat(by, voxelDifference(place, from)), 1.0f);
    PRECISE float nearest = by.margin * MARGIN_INWARD;
    PRECISE float square = nearest * nearest + slack * slack;
    return least.x < most.x && least.y < most.y && least.z < most.z && voxelDot(way, way) <= square;
}
#endif

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

#if defined(TURN)
/// The direction from where the point of a box that is nearest to another gets, to that; without a turn it is `apart`,
/// flat.
EXACT VoxelPoint marginAlongMoved(MarginSpace by, CertifiedReach reach, VoxelPoint middle, VoxelPoint apart) {
    const VoxelPoint near =
        voxelPoint(certifiedClamp(middle.x, reach.lo.x, reach.hi.x), certifiedClamp(middle.y, reach.lo.y, reach.hi.y),
                   certifiedClamp(middle.z, reach.lo.z, reach.hi.z));
    const VoxelPoint arm = marginFlat(by, voxelDifference(near, by.pivot));
    const VoxelPoint wanted = voxelStep(arm, apart, 1.0f);
    return voxelDifference(wanted, turnTowards(by.turn, arm, wanted));
}

/// What a turn adds to the shadow of all that is in a box: to that of its middle, and of what is about this.
EXACT float marginSurplus(MarginSpace by, CertifiedReach reach, VoxelPoint along) {
    const VoxelPoint middle = voxelStep(reach.lo, voxelDifference(reach.hi, reach.lo), 0.5f);
    const VoxelPoint about = voxelDifference(reach.hi, middle);
    PRECISE float surplus = turnSurplus(by.turn, along, marginFlat(by, voxelDifference(middle, by.pivot))) +
                            turnLength(along) * marginLongest(by, about) * by.turn.chord * MARGIN_OUTWARD;
    return surplus;
}
#elif defined(MOVE)
/// The direction from where the middle of a box gets that is nearest to another, to that; at its own pose it is
/// `apart`, flat.
EXACT VoxelPoint marginAlongMoved(MarginSpace by, CertifiedReach reach, VoxelPoint middle, VoxelPoint apart) {
    const VoxelPoint own = voxelStep(reach.lo, voxelDifference(reach.hi, reach.lo), 0.5f);
    const VoxelPoint move = marginFlat(by, moveOf(by.move, voxelDifference(own, by.pivot)));
    return voxelStep(apart, move, -marginShare(apart, move));
}

/// What a piece of the way adds to the shadow of all that is in a box.
EXACT float marginSurplus(MarginSpace by, CertifiedReach reach, VoxelPoint along) {
    const VoxelPoint middle = voxelStep(reach.lo, voxelDifference(reach.hi, reach.lo), 0.5f);
    const VoxelPoint radius = voxelDifference(reach.hi, middle);
    const MarginMove all = marginMoveAbout(by, middle, radius);
    const VoxelPoint pulled = marginPulled(by, along);
    const VoxelPoint spread = moveSpread(by.move, radius);
    PRECISE float surplus = certifiedAbs(voxelDot(pulled, all.move)) + certifiedAbs(pulled.x) * spread.x +
                            certifiedAbs(pulled.y) * spread.y + certifiedAbs(pulled.z) * spread.z +
                            turnLength(along) * all.turning * by.move.bend * MARGIN_OUTWARD;
    return surplus;
}
#endif

/// Of a box, and of all that `reach` says triangles are in.
EXACT MarginApart marginReachApart(MarginSpace by, CertifiedReach reach, VoxelPoint middle, VoxelPoint radius) {
    const VoxelPoint apart = voxelPoint(marginApart(reach.lo.x, reach.hi.x, middle.x, radius.x),
                                        marginApart(reach.lo.y, reach.hi.y, middle.y, radius.y),
                                        marginApart(reach.lo.z, reach.hi.z, middle.z, radius.z));
#if defined(TURN) || defined(MOVE)
    const VoxelPoint along = marginAlongMoved(by, reach, middle, marginFlat(by, apart));
#else
    const VoxelPoint along = marginFlat(by, apart);
#endif
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
#if defined(TURN) || defined(MOVE)
    PRECISE float left = gap - marginSurplus(by, reach, along);
    found.gap = left;
#endif
    found.slack = marginMovedSlack(by, voxelDifference(by.pivot, middle), reach.delta, farthest);
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
