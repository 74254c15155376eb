// SPDX-License-Identifier: MIT
// What certified_margin.h asks of a mesh that goes a piece of its way (MOVE), the centre being MarginSpace::pivot; what
// each function says is there. One text for GLSL and C++.
#ifndef VOXTACT_CERTIFIED_MARGIN_MOVE_H
#define VOXTACT_CERTIFIED_MARGIN_MOVE_H

#include "certified_margin_space.h"

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

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

EXACT MarginTriangle marginLocal(MarginSpace, MarginTriangle about, float) {
    return about;
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

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
