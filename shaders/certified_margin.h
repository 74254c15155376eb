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
//
// What differs between a mesh that stays, one that is turned and one that moves is in a header each, with the same
// functions: marginMovedSlack(), what marginSlack() is for it; marginGrow(), how far along each axis all that is in a
// box reaches; marginLocal(), what of a triangle matters there; marginNear(), what of it is or gets nearest to a point;
// and, where it does not move on, marginWay(), from there to the point.
#ifndef VOXTACT_CERTIFIED_MARGIN_H
#define VOXTACT_CERTIFIED_MARGIN_H

#if defined(TURN)
#include "certified_margin_turn.h"
#elif defined(MOVE)
#include "certified_margin_move.h"
#else
#include "certified_margin_still.h"
#endif

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
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
    return marginLocal(by, about, reach);
}

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
