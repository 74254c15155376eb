// SPDX-License-Identifier: MIT
// The projection `conservative` with a pose tolerance: how far a turn about a point by no more than an angle brings
// what is turned. Vectors are of flat space (certified_margin.h), from that point. One text for GLSL and C++.
//
// A turn is linear, so what of a body gets farthest along a direction is one of its corners. A point gets there by
// being turned towards the direction, in the plane of the two.
#ifndef VOXTACT_CERTIFIED_TURN_H
#define VOXTACT_CERTIFIED_TURN_H

#include "certified_triangle.h"

/// More than the roundings of a root and of a product.
#define TURN_OUTWARD 1.0000038146972656f
/// Of a length: nearer to the point, nothing is turned.
#define TURN_LEAST_SQUARE 1.0e-12f

#ifdef __cplusplus
#include <cmath>
#endif

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
using std::sqrt;
#endif

/// Of the largest angle, which is up to a half turn. By what they are rounded is less than MARGIN_ROUNDING has.
struct TurnLimit {
    float cosine;
    float sine;
    float chord; // of what is turned by it, over the distance; rounded up
};

EXACT float turnLength(VoxelPoint v) {
    PRECISE float length = sqrt(voxelDot(v, v)) * TURN_OUTWARD;
    return length;
}

/// The product of two lengths and of the sine of the angle between.
EXACT float turnAcross(VoxelPoint a, VoxelPoint b) {
    const VoxelPoint normal = voxelCross(a, b);
    return sqrt(voxelDot(normal, normal));
}

/// Whether `arm` can be turned to where `towards` points: sin(between - largest angle) is not above 0.
EXACT bool turnGets(TurnLimit by, float across, float along) {
    PRECISE float beyond = across * by.cosine - along * by.sine;
    return beyond <= 0.0f;
}

/// How much farther along `direction` a turn brings `arm`, times the length of the direction; not less than that.
EXACT float turnSurplus(TurnLimit by, VoxelPoint direction, VoxelPoint arm) {
    const float along = voxelDot(direction, arm);
    const float across = turnAcross(direction, arm);
    PRECISE float whole = turnLength(direction) * turnLength(arm) - along;
    PRECISE float versine = by.chord * by.chord * 0.5f; // 1 - cosine
    PRECISE float part = across * by.sine * TURN_OUTWARD - along * versine;
    return certifiedMax(turnGets(by, across, along) ? whole : part, 0.0f);
}

/// `arm`, turned towards `wanted` as far as it gets. Whatever rounding did, a turn that is allowed brings it as near to
/// there as MARGIN_ROUNDING says of its length.
EXACT VoxelPoint turnTowards(TurnLimit by, VoxelPoint arm, VoxelPoint wanted) {
    const float armSquare = voxelDot(arm, arm);
    const float wantedSquare = voxelDot(wanted, wanted);
    if (!(armSquare > TURN_LEAST_SQUARE && wantedSquare > TURN_LEAST_SQUARE)) {
        return arm;
    }
    const float along = voxelDot(arm, wanted);
    const VoxelPoint none = voxelPoint(0.0f, 0.0f, 0.0f);
    if (turnGets(by, turnAcross(arm, wanted), along)) {
        return voxelStep(none, wanted, sqrt(armSquare * exactReciprocal(wantedSquare)));
    }
    // What of the other is at right angles to the arm; and once more, because where the two are nearly opposite, hardly
    // anything is. Turned towards whatever is at right angles, it is turned by the angle.
    const float perSquare = exactReciprocal(armSquare);
    VoxelPoint aside = wanted;
    for (int i = 0; i < 2; ++i) {
        aside = voxelStep(aside, arm, -voxelDot(arm, aside) * perSquare);
    }
    const float asideSquare = voxelDot(aside, aside);
    PRECISE float least = wantedSquare * TURN_LEAST_SQUARE;
    if (!(asideSquare > least)) {
        return arm;
    }
    PRECISE float weight = by.sine * sqrt(armSquare * exactReciprocal(asideSquare));
    return voxelStep(voxelStep(none, arm, by.cosine), aside, weight);
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
