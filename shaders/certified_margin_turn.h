// SPDX-License-Identifier: MIT
// What certified_margin.h asks of a mesh that may be turned (TURN), about MarginSpace::pivot; what each function says
// is there. One text for GLSL and C++.
#ifndef VOXTACT_CERTIFIED_MARGIN_TURN_H
#define VOXTACT_CERTIFIED_MARGIN_TURN_H

#include "certified_margin_space.h"

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

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

/// What a turn brings to within the margin of a box keeps its distance from the pivot, and so was no farther from there
/// than a chord. Of a large triangle that is a small part: taken whole, it would seem to be turned as far as its
/// farthest corner. `reach`: of the box's coordinates, the largest.
EXACT MarginTriangle marginLocal(MarginSpace by, MarginTriangle given, float reach) {
    MarginTriangle about = given;
    PRECISE float near = by.margin + by.size * reach + about.slack * 4.0f + MARGIN_FARTHER * 2.0f;
    PRECISE float chord = (turnLength(marginFlat(by, about.pivot)) + near) * by.turn.chord;
    PRECISE float most = (chord + near) * MARGIN_OUTWARD;
    const VoxelPoint none = voxelPoint(0.0f, 0.0f, 0.0f);
    const VoxelPoint first = marginFlat(by, about.a);
    const VoxelPoint offs[3] = {none, voxelDifference(marginFlat(by, about.b), first),
                                voxelDifference(marginFlat(by, about.c), first)};
    const VoxelPoint third = voxelDifference(offs[2], offs[1]);
    VoxelPoint longest = voxelDot(offs[1], offs[1]) >= voxelDot(offs[2], offs[2]) ? offs[1] : offs[2];
    longest = voxelDot(third, third) > voxelDot(longest, longest) ? third : longest;
    // The two must be of length 1 and at right angles, or places are not what their coordinates say: so what rounding
    // leaves along the first is taken away once more, and a width that is rounding itself is none.
    const float square = voxelDot(longest, longest);
    const VoxelPoint u = voxelStep(none, longest, marginInverse(sqrt(square)));
    VoxelPoint aside = none;
    for (int i = 1; i < 3; ++i) {
        const VoxelPoint once = voxelStep(offs[i], u, -voxelDot(offs[i], u));
        const VoxelPoint own = voxelStep(once, u, -voxelDot(once, u));
        aside = voxelDot(own, own) > voxelDot(aside, aside) ? own : aside;
    }
    const float width = voxelDot(aside, aside);
    PRECISE float leastWidth = square * TURN_LEAST_SQUARE;
    const VoxelPoint v = voxelStep(none, aside, width > leastWidth ? marginInverse(sqrt(width)) : 0.0f);
    PRECISE float middleU = -voxelDot(first, u);
    PRECISE float middleV = -voxelDot(first, v);
    float lo[2] = {0.0f, 0.0f};
    float hi[2] = {0.0f, 0.0f};
    for (int i = 1; i < 3; ++i) {
        const float alongU = voxelDot(offs[i], u);
        const float alongV = voxelDot(offs[i], v);
        lo[0] = certifiedMin(lo[0], alongU);
        hi[0] = certifiedMax(hi[0], alongU);
        lo[1] = certifiedMin(lo[1], alongV);
        hi[1] = certifiedMax(hi[1], alongV);
    }
    // Where none of it is as near, this is one side of the triangle, which is too much.
    PRECISE float leastU = certifiedMin(certifiedMax(lo[0], middleU - most), hi[0]);
    PRECISE float mostU = certifiedMax(certifiedMin(hi[0], middleU + most), lo[0]);
    PRECISE float leastV = certifiedMin(certifiedMax(lo[1], middleV - most), hi[1]);
    PRECISE float mostV = certifiedMax(certifiedMin(hi[1], middleV + most), lo[1]);
    for (int i = 0; i < 4; ++i) {
        about.rim[i] = voxelStep(voxelStep(first, u, (i & 1) == 0 ? leastU : mostU), v, (i & 2) == 0 ? leastV : mostV);
    }
    return about;
}

/// The way to a point from what is `near` it, which is turned towards it first. Flat.
EXACT VoxelPoint marginWay(MarginSpace by, VoxelPoint pivot, VoxelPoint near, VoxelPoint at) {
    const VoxelPoint wanted = marginFlat(by, voxelDifference(at, pivot));
    const VoxelPoint arm = marginFlat(by, voxelDifference(near, pivot));
    return voxelDifference(wanted, turnTowards(by.turn, arm, wanted));
}

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
    const VoxelPoint flatFrom = marginFlat(by, from);
    const VoxelPoint flatPivot = marginFlat(by, triangle.pivot);
    float local = -3.0e38f;
    for (int i = 0; i < 4; ++i) {
        const VoxelPoint corner = voxelDifference(triangle.rim[i], flatFrom);
        const VoxelPoint own = voxelDifference(triangle.rim[i], flatPivot);
        PRECISE float shadow = voxelDot(near.along, corner) + turnSurplus(by.turn, near.along, own);
        local = certifiedMax(local, shadow);
    }
    PRECISE float rounded = local + turnLength(near.along) * triangle.slack;
    near.shadow = certifiedMin(near.shadow, rounded);
    return near;
}

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

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
