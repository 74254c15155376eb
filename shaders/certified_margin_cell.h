// SPDX-License-Identifier: MIT
// The projection `conservative` with a margin: whether a point of a voxel cell is opaque and within the margin of a
// triangle. The cell is halved into boxes. A box is dropped where no value in it may be opaque, or where it is, or what
// in it may be opaque, farther than the margin; a point of it that is opaque and within the margin decides.
//
// In a box the interpolant differs from its linear part by no more than the sum of its mixed coefficients: what is
// opaque lies on one side of a plane. The shadow of box and half-space follows by weak duality: each multiplier gives a
// bound, and the best is one of four.
#ifndef VOXTACT_CERTIFIED_MARGIN_CELL_H
#define VOXTACT_CERTIFIED_MARGIN_CELL_H

#include "certified_margin.h"

/// Boxes that wait: one for each halving, and two. A side of a cell, no longer than 2 in flat space, is halved until it
/// is no longer than the least.
#define MARGIN_STACK 32
#ifdef MOVE
#define MARGIN_LEAST_SIDE 0.001953125f // it is asked of pieces that are as short
#else
#define MARGIN_LEAST_SIDE 0.0078125f
#endif
/// Boxes of a cell that are looked at before it is left undecided, and those of the least size that are left open.
#ifdef MOVE
#define MARGIN_MOST_BOXES 2048
#define MARGIN_MOST_OPEN 1 // it is then known that not all of the way is free
#else
#define MARGIN_MOST_BOXES 512
#define MARGIN_MOST_OPEN 64
#endif
/// Halvings of a range of values, to find where it begins to be opaque.
#define MARGIN_VALUE_STEPS 18
#define MARGIN_VALUE_STEP 7.62939453125e-6f
/// Of pointError in CertifiedCell, which is of one interpolation: more than a linear part in a box is off by.
#define MARGIN_PLANE_ERROR 4.0f

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

/// A box in a cell, relative to the cell's corner.
struct MarginBox {
    VoxelPoint lo, hi;
};

EXACT VoxelPoint marginMiddle(MarginBox box) {
    return voxelStep(box.lo, voxelDifference(box.hi, box.lo), 0.5f);
}

/// Half of its sides.
EXACT VoxelPoint marginRadius(MarginBox box) {
    PRECISE float x = (box.hi.x - box.lo.x) * 0.5f;
    PRECISE float y = (box.hi.y - box.lo.y) * 0.5f;
    PRECISE float z = (box.hi.z - box.lo.z) * 0.5f;
    return voxelPoint(x, y, z);
}

/// The entry coordinates of a cell that may be opaque are from `first` to `last`.
struct MarginValues {
    float first, last;
};

/// What is known of points that are certainly within the margin: the least and the greatest entry coordinate.
struct MarginSamples {
    bool some;
    float lo, hi;
};

EXACT MarginSamples marginNoSamples() {
    MarginSamples none;
    none.some = false;
    none.lo = 0.0f;
    none.hi = 0.0f;
    return none;
}

/// Whether a corner of the cell is not a number: then no sample of it is, and none is opaque. Not where nothing is
/// known of entry coordinates.
EXACT bool marginIsNothing(CertifiedCell cell) {
    const float corners[8] = {cell.x000, cell.x100, cell.x010, cell.x110, cell.x001, cell.x101, cell.x011, cell.x111};
    bool all = true;
    for (int i = 0; i < 8; ++i) {
        all = all && corners[i] == corners[i];
    }
    return !all && cell.pointError <= CERTIFIED_FARTHEST;
}

/// Of entry coordinates from `below` to `above`. What is `known` of more of them is taken where it is one of these.
/// `most`: halvings; no number of them makes it wrong.
EXACT MarginValues marginValues(OpacityTable table, float below, float above, MarginValues known, int most) {
    MarginValues values = known;
    for (int side = 0; side < 2; ++side) {
        const bool ofFirst = side == 0;
        if (ofFirst ? known.first >= below : known.last <= above) {
            continue;
        }
        float clear = ofFirst ? below : above; // from the end to here nothing is opaque
        float other = ofFirst ? above : below;
        const int steps = mayBeOpaque(table, clear, clear) ? 0 : most;
        for (int step = 0; step < steps; ++step) {
            PRECISE float middle = clear * 0.5f + other * 0.5f;
            if (mayBeOpaque(table, ofFirst ? below : middle, ofFirst ? middle : above)) {
                other = middle;
            } else {
                clear = middle;
            }
        }
        if (ofFirst) {
            values.first = clear;
        } else {
            values.last = clear;
        }
    }
    return values;
}

/// Of all that a cell may have.
EXACT MarginValues marginCellValues(OpacityTable table, CertifiedCell cell, int most) {
    PRECISE float below = cell.least - cell.pointError;
    PRECISE float above = cell.greatest + cell.pointError;
    MarginValues none;
    none.first = -CERTIFIED_FARTHEST;
    none.last = CERTIFIED_FARTHEST;
    return marginValues(table, below, above, none, most);
}

/// Takes a point of the cell that is certainly within the margin into account. Whether that proves something opaque
/// there: the point is, or something between two such points. What is within a distance of a triangle is convex, so the
/// way from one to the other is within the margin, too, and the interpolant is continuous along it.
EXACT bool marginPointProves(OpacityTable table, CertifiedCell cell, VoxelPoint at, INOUT(MarginSamples) samples) {
    const float entry = certifiedInterpolate(cell, at.x, at.y, at.z);
    samples.lo = !samples.some || entry < samples.lo ? entry : samples.lo;
    samples.hi = !samples.some || entry > samples.hi ? entry : samples.hi;
    samples.some = true;
    PRECISE float below = entry - cell.pointError;
    PRECISE float above = entry + cell.pointError;
    PRECISE float least = samples.lo + cell.pointError;
    PRECISE float most = samples.hi - cell.pointError;
    return certainlyAllOpaque(table, below, above) || certainlySomeOpaque(table, least, most);
}

/// The interpolant in a box, about its middle.
struct MarginLinear {
    float lo, hi;        // of its values
    float middle;        // the linear part: there,
    VoxelPoint gradient; // and what a voxel adds
    float mixed;         // no value is farther from the linear part
};

EXACT MarginLinear marginLinear(CertifiedCell cell, MarginBox box) {
    float corner[8];
    for (int i = 0; i < 8; ++i) {
        corner[i] = certifiedInterpolate(cell, (i & 1) == 0 ? box.lo.x : box.hi.x, (i & 2) == 0 ? box.lo.y : box.hi.y,
                                         (i & 4) == 0 ? box.lo.z : box.hi.z);
    }
    MarginLinear found;
    found.lo = corner[0];
    found.hi = corner[0];
    for (int i = 1; i < 8; ++i) {
        found.lo = certifiedMin(found.lo, corner[i]);
        found.hi = certifiedMax(found.hi, corner[i]);
    }
    // The sums with signs: x has the lowest bit. Loops of a known length are unrolled, and the corners kept in
    // registers.
    for (int axis = 0; axis < 3; ++axis) {
        const int bit = 1 << axis;
        for (int i = 0; i < 8; ++i) {
            if ((i & bit) == 0) {
                PRECISE float sum = corner[i] + corner[i + bit];
                PRECISE float difference = corner[i + bit] - corner[i];
                corner[i] = sum;
                corner[i + bit] = difference;
            }
        }
    }
    PRECISE float middle = corner[0] * 0.125f;
    PRECISE float mixed =
        (certifiedAbs(corner[3]) + certifiedAbs(corner[5]) + certifiedAbs(corner[6]) + certifiedAbs(corner[7])) *
        0.125f;
    found.middle = middle;
    found.mixed = mixed;
    // Over the half of the box, which is divided by below.
    found.gradient = voxelPoint(corner[1] * 0.125f, corner[2] * 0.125f, corner[4] * 0.125f);
    return found;
}

/// The least that a direction says of the points of a box, in units of its half sides, where sign * (gradient * x) is
/// at least `least`: `pulled` is the direction in these units. Weak duality; the best multiplier makes a component
/// zero.
EXACT float marginPartShadow(VoxelPoint pulled, VoxelPoint gradient, float least, float whole) {
    const float ofPulled[3] = {pulled.x, pulled.y, pulled.z};
    const float ofGradient[3] = {gradient.x, gradient.y, gradient.z};
    PRECISE float pulledSize = certifiedAbs(pulled.x) + certifiedAbs(pulled.y) + certifiedAbs(pulled.z);
    PRECISE float gradientSize = certifiedAbs(gradient.x) + certifiedAbs(gradient.y) + certifiedAbs(gradient.z);
    float best = whole;
    for (int i = 0; i < 3; ++i) {
        const float size = certifiedAbs(ofGradient[i]);
        PRECISE float ratio = ofPulled[i] * marginInverse(size) * (ofGradient[i] < 0.0f ? -1.0f : 1.0f);
        const VoxelPoint rest = voxelStep(pulled, gradient, -ratio);
        PRECISE float gained = ratio * least;
        PRECISE float lost = certifiedAbs(rest.x) + certifiedAbs(rest.y) + certifiedAbs(rest.z);
        PRECISE float terms = certifiedAbs(gained) + pulledSize + certifiedAbs(ratio) * gradientSize;
        PRECISE float bound = gained - lost - terms * MARGIN_ROUNDING;
        best = ratio > 0.0f && bound > best ? bound : best;
    }
    return best;
}

/// The gap between the shadows of the triangle, and of what in a box may be opaque, on the direction `near.along`.
EXACT float marginPartGap(MarginSpace by, CertifiedCell cell, MarginValues values, MarginNear near, MarginLinear linear,
                          VoxelPoint radius) {
    const VoxelPoint pulled = marginPulled(by, near.along);
    PRECISE float x = pulled.x * radius.x;
    PRECISE float y = pulled.y * radius.y;
    PRECISE float z = pulled.z * radius.z;
    const VoxelPoint scaled = voxelPoint(x, y, z);
    const float whole = marginBoxShadow(pulled, radius);
    PRECISE float unsure = linear.mixed + cell.pointError * MARGIN_PLANE_ERROR;
    PRECISE float above = values.first - linear.middle - unsure;
    PRECISE float below = linear.middle - values.last - unsure;
    const VoxelPoint less = voxelPoint(-linear.gradient.x, -linear.gradient.y, -linear.gradient.z);
    const float shadow = certifiedMax(marginPartShadow(scaled, linear.gradient, above, whole),
                                      marginPartShadow(scaled, less, below, whole));
    PRECISE float gap = shadow - near.shadow;
    return gap;
}

/// Whether what in a box may be opaque is certainly farther from the triangle than the margin.
EXACT bool marginPartBeyond(MarginSpace by, CertifiedCell cell, MarginTriangle triangle, MarginValues values,
                            MarginNear near, MarginLinear linear, VoxelPoint radius) {
    return marginBeyond(by, triangle.slack, marginPartGap(by, cell, values, near, linear, radius),
                        voxelDot(near.along, near.along));
}

EXACT VoxelPoint marginClamped(MarginBox box, VoxelPoint at) {
    return voxelPoint(certifiedClamp(at.x, box.lo.x, box.hi.x), certifiedClamp(at.y, box.lo.y, box.hi.y),
                      certifiedClamp(at.z, box.lo.z, box.hi.z));
}

/// The direction of voxel space in which a value rises fastest in the world, from what a voxel along each axis adds.
EXACT VoxelPoint marginRise(MarginSpace by, VoxelPoint gradient) {
    const float perX = marginInverse(by.xx);
    const float perY = marginInverse(by.yy);
    const float perZ = marginInverse(by.zz);
    // The transposed matrix first, and then the matrix itself.
    PRECISE float firstX = gradient.x * perX;
    PRECISE float firstY = (gradient.y - by.xy * firstX) * perY;
    PRECISE float firstZ = (gradient.z - by.xz * firstX - by.yz * firstY) * perZ;
    PRECISE float z = firstZ * perZ;
    PRECISE float y = (firstY - by.yz * z) * perY;
    PRECISE float x = (firstX - by.xy * y - by.xz * z) * perX;
    return voxelPoint(x, y, z);
}

/// Where the linear part says that the box begins to be opaque, seen from `from`: the foot of the perpendicular of the
/// world. Any point, where it says nothing.
EXACT VoxelPoint marginFoot(MarginSpace by, CertifiedCell cell, MarginValues values, MarginLinear linear,
                            VoxelPoint middle, VoxelPoint radius, VoxelPoint from) {
    PRECISE float perX = linear.gradient.x * marginInverse(radius.x);
    PRECISE float perY = linear.gradient.y * marginInverse(radius.y);
    PRECISE float perZ = linear.gradient.z * marginInverse(radius.z);
    const VoxelPoint gradient = voxelPoint(perX, perY, perZ);
    const VoxelPoint rise = marginRise(by, gradient);
    PRECISE float entry = linear.middle + voxelDot(gradient, voxelDifference(from, middle));
    // A little beyond, but no farther than half of what is opaque.
    PRECISE float deeper = cell.pointError * 2.0f + linear.mixed + (cell.greatest - cell.least) * MARGIN_VALUE_STEP;
    PRECISE float middleEntry = values.first * 0.5f + values.last * 0.5f;
    PRECISE float first = certifiedMin(values.first + deeper, middleEntry);
    PRECISE float last = certifiedMax(values.last - deeper, middleEntry);
    PRECISE float wanted = certifiedClamp(entry, first, last);
    PRECISE float weight = (wanted - entry) * marginInverse(voxelDot(gradient, rise));
    return voxelStep(from, rise, weight);
}

#ifdef MOVE
/// Whether what in a box may be opaque is certainly apart from all of the way, along the direction in which the linear
/// part rises or falls: where the way runs by at a small distance, the direction to the box's middle says nothing.
EXACT bool marginRiseBeyond(MarginSpace by, CertifiedCell cell, MarginTriangle triangle, MarginValues values,
                            MarginLinear linear, VoxelPoint middle, VoxelPoint radius) {
    PRECISE float gradientX = linear.gradient.x * marginInverse(radius.x);
    PRECISE float gradientY = linear.gradient.y * marginInverse(radius.y);
    PRECISE float gradientZ = linear.gradient.z * marginInverse(radius.z);
    const float side = linear.middle < values.first ? 1.0f : (linear.middle > values.last ? -1.0f : 0.0f);
    // What is pulled to the gradient: the transposed matrix, from the first axis on.
    PRECISE float x = gradientX * side * marginInverse(by.xx);
    PRECISE float y = (gradientY * side - by.xy * x) * marginInverse(by.yy);
    PRECISE float z = (gradientZ * side - by.xz * x - by.yz * y) * marginInverse(by.zz);
    const float size = voxelLength(voxelPoint(x, y, z));
    const VoxelPoint along = voxelStep(voxelPoint(0.0f, 0.0f, 0.0f), voxelPoint(x, y, z), marginInverse(size));
    return marginPartBeyond(by, cell, triangle, values, marginAlong(by, triangle, middle, along), linear, radius);
}

/// Whether some of the way meets a box that is opaque all over, as far as rounding lets it.
EXACT bool marginBoxProves(OpacityTable table, CertifiedCell cell, MarginLinear linear, MarginBox box,
                           MarginNear near) {
    PRECISE float below = linear.lo - cell.pointError;
    PRECISE float above = linear.hi + cell.pointError;
    const VoxelPoint off = voxelDifference(marginClamped(box, near.moved), near.moved);
    return !(voxelLength(off) > 0.0f) && certainlyAllOpaque(table, below, above);
}
#else
/// Whether one of three points of a box proves something opaque within the margin: its middle, what is nearest to the
/// triangle, and what is nearest to that where the box begins to be opaque.
EXACT bool marginBoxProves(OpacityTable table, MarginSpace by, CertifiedCell cell, MarginTriangle triangle,
                           MarginValues values, MarginLinear linear, MarginBox box, VoxelPoint middle,
                           VoxelPoint radius, MarginNear near, INOUT(MarginSamples) samples) {
#ifdef TURN
    PRECISE float below = linear.lo - cell.pointError;
    PRECISE float above = linear.hi + cell.pointError;
    if (certainlyAllOpaque(table, below, above) && marginInto(by, triangle.slack, near, middle, box.lo, box.hi)) {
        return true;
    }
#endif
    const VoxelPoint foot = marginFoot(by, cell, values, linear, middle, radius, near.moved);
    const VoxelPoint points[3] = {middle, near.moved, foot};
    bool proven = false;
    for (int i = 0; i < 3 && !proven; ++i) {
        const VoxelPoint at = marginClamped(box, points[i]);
#ifdef TURN
        samples = marginNoSamples(); // what some turn brings within the margin is not convex
#endif
        proven = marginWithin(by, triangle.pivot, triangle.slack, near.at, at) &&
                 marginPointProves(table, cell, at, samples);
    }
    return proven;
}
#endif

/// What one look at a box says, and which half of it is nearer along each axis.
struct MarginLook {
    int verdict;
    VoxelPoint pulled; // negative along an axis: the far half is nearer
};

EXACT MarginLook marginLook(OpacityTable table, MarginSpace by, CertifiedCell cell, MarginTriangle triangle,
                            MarginValues known, MarginBox box, INOUT(MarginSamples) samples) {
    const VoxelPoint middle = marginMiddle(box);
    const VoxelPoint radius = marginRadius(box);
    MarginLook look;
    look.verdict = CERTIFIED_NONE;
    look.pulled = middle;
    const MarginLinear linear = marginLinear(cell, box);
    if (!certifiedMayBeOpaque(table, linear.lo, linear.hi, cell.pointError)) {
        return look;
    }
    PRECISE float below = linear.lo - cell.pointError;
    PRECISE float above = linear.hi + cell.pointError;
    const MarginValues values = marginValues(table, below, above, known, MARGIN_VALUE_STEPS);
    const MarginNear near = marginNear(by, triangle, middle);
    look.pulled = marginPulled(by, near.along);
    if (marginPartBeyond(by, cell, triangle, values, near, linear, radius)) {
        return look;
    }
#ifdef MOVE
    if (marginRiseBeyond(by, cell, triangle, values, linear, middle, radius)) {
        return look;
    }
    const bool proven = marginBoxProves(table, cell, linear, box, near);
#else
    const bool proven = marginBoxProves(table, by, cell, triangle, values, linear, box, middle, radius, near, samples);
#endif
    look.verdict = proven ? CERTIFIED_CERTAIN : CERTIFIED_UNDECIDED;
    return look;
}

EXACT float marginSide(float a, float b, float c, float lo, float hi) {
    PRECISE float side = (certifiedAbs(a) + certifiedAbs(b) + certifiedAbs(c)) * (hi - lo);
    return side;
}

/// The axis along which a box is longest, in the world; -1 where it is no longer than the least side.
EXACT int marginLongest(MarginSpace by, MarginBox box) {
    const float x = marginSide(by.xx, 0.0f, 0.0f, box.lo.x, box.hi.x);
    const float y = marginSide(by.xy, by.yy, 0.0f, box.lo.y, box.hi.y);
    const float z = marginSide(by.xz, by.yz, by.zz, box.lo.z, box.hi.z);
    const float longest = certifiedMax(x, certifiedMax(y, z));
#ifdef MOVE
    const float least = certifiedMax(by.leastSide, MARGIN_LEAST_SIDE);
#else
    const float least = MARGIN_LEAST_SIDE;
#endif
    if (!(longest > least)) {
        return -1;
    }
    return x >= longest ? 0 : (y >= longest ? 1 : 2);
}

/// A box up to `at` along an axis, or from there.
EXACT MarginBox marginHalf(MarginBox box, int axis, float at, bool upper) {
    MarginBox part = box;
    if (upper) {
        part.lo.x = axis == 0 ? at : box.lo.x;
        part.lo.y = axis == 1 ? at : box.lo.y;
        part.lo.z = axis == 2 ? at : box.lo.z;
    } else {
        part.hi.x = axis == 0 ? at : box.hi.x;
        part.hi.y = axis == 1 ? at : box.hi.y;
        part.hi.z = axis == 2 ? at : box.hi.z;
    }
    return part;
}

EXACT MarginBox marginCellBox(CertifiedCell cell) {
    MarginBox box;
    box.lo = cell.lo;
    box.hi = cell.hi;
    return box;
}

/// Decides a cell of a triangle: CERTIFIED_CERTAIN where something opaque in it is within the margin. `corner`: where
/// the cell's corner is in voxel space. Expects a triangle whose places are known (CertifiedBounds::usable).
EXACT int marginDecide(OpacityTable table, MarginSpace by, CertifiedTriangle triangle, CertifiedCell cell,
                       VoxelPoint corner) {
    const MarginTriangle about = marginTriangle(by, triangle, corner, 1.0f);
    const MarginValues values = marginCellValues(table, cell, MARGIN_VALUE_STEPS);
    MarginSamples samples = marginNoSamples();
    MarginBox stack[MARGIN_STACK];
    stack[0] = marginCellBox(cell);
    int waiting = 1;
    int open = 0;
    for (int boxes = 0; waiting > 0; ++boxes) {
        if (boxes == MARGIN_MOST_BOXES || open == MARGIN_MOST_OPEN) {
            return CERTIFIED_UNDECIDED;
        }
        const MarginBox box = stack[--waiting];
        const MarginLook look = marginLook(table, by, cell, about, values, box, samples);
        if (look.verdict == CERTIFIED_CERTAIN) {
            return CERTIFIED_CERTAIN;
        }
        if (look.verdict == CERTIFIED_NONE) {
            continue;
        }
        const int axis = marginLongest(by, box);
        if (axis < 0 || waiting + 2 > MARGIN_STACK) {
            ++open;
            continue;
        }
        PRECISE float at = (voxelAlong(box.lo, axis) + voxelAlong(box.hi, axis)) * 0.5f;
        const bool upperFirst = voxelAlong(look.pulled, axis) < 0.0f;
        stack[waiting++] = marginHalf(box, axis, at, !upperFirst);
        stack[waiting++] = marginHalf(box, axis, at, upperFirst);
    }
    return open > 0 ? CERTIFIED_UNDECIDED : CERTIFIED_NONE;
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
