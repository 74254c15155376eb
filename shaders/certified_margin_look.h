// SPDX-License-Identifier: MIT
// The projection `conservative` with a margin, before a cell is halved: what all of a cell or of a brick says, and what
// a vertex proves of the places about it.
#ifndef VOXTACT_CERTIFIED_MARGIN_LOOK_H
#define VOXTACT_CERTIFIED_MARGIN_LOOK_H

#include "certified_margin_cell.h"

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

/// Whether a cell needs a decision: it may have something opaque.
EXACT bool marginCellMay(OpacityTable table, CertifiedCell cell) {
    return !marginIsNothing(cell) && certifiedCellMayBeOpaque(table, cell);
}

/// What all of a cell says of itself: bits of marginCellHas().
#define MARGIN_HAS_SOME 1 // something in it is certainly opaque
#define MARGIN_HAS_ALL 2  // all of it is

/// Of a cell that may have something opaque. It takes all values between its corners', and these are in the domain. Of
/// a cell that may have a corner that is no number, nothing.
EXACT int marginCellHas(OpacityTable table, CertifiedCell cell) {
    if (!(cell.pointError <= CERTIFIED_FARTHEST)) {
        return 0;
    }
    PRECISE float leastBelow = cell.least - cell.pointError;
    PRECISE float greatestAbove = cell.greatest + cell.pointError;
    PRECISE float leastAbove = cell.least + cell.pointError;
    PRECISE float greatestBelow = cell.greatest - cell.pointError;
    const bool all = certainlyAllOpaque(table, leastBelow, greatestAbove);
    const bool some = all || certainlySomeOpaque(table, leastAbove, greatestBelow);
    return (some ? MARGIN_HAS_SOME : 0) + (all ? MARGIN_HAS_ALL : 0);
}

/// No point of a cell is farther from its middle, flat. For a >= b >= c, the root of a^2 + b^2 + c^2 is no more than
/// a + 0.415 b + 0.319 c: it is convex, and not more for (1, 0, 0), (1, 1, 0) and (1, 1, 1).
EXACT float marginCellRadius(MarginSpace by) {
    const float x = marginSide(by.xx, by.xy, by.xz, 0.0f, 1.0f);
    const float y = marginSide(by.yy, by.yz, 0.0f, 0.0f, 1.0f);
    const float z = marginSide(by.zz, 0.0f, 0.0f, 0.0f, 1.0f);
    const float most = certifiedMax(x, certifiedMax(y, z));
    const float least = certifiedMin(x, certifiedMin(y, z));
    const float second = certifiedMax(certifiedMin(x, y), certifiedMin(certifiedMax(x, y), z));
    PRECISE float twice = most + second * 0.415f + least * 0.319f;
    PRECISE float radius = twice * 0.5f * MARGIN_OUTWARD;
    return radius;
}

/// A place, about a cell's middle, to the nearest along each axis that is in the cell and in the domain.
EXACT float marginInCell(float at, int cell, int size) {
    return certifiedClamp(at, cell < 0 ? 0.0f : -0.5f, cell == size - 1 ? 0.0f : 0.5f);
}

#ifdef MOVE
/// Whether some of the way meets a cell that is opaque all over, as far as rounding lets it.
EXACT bool marginCellProves(MarginSpace by, CertifiedItem item, MarginTriangle about, MarginNear near, int has, int x,
                            int y, int z) {
    const VoxelPoint nearest =
        voxelPoint(marginInCell(near.moved.x, x, item.sizeX), marginInCell(near.moved.y, y, item.sizeY),
                   marginInCell(near.moved.z, z, item.sizeZ));
    return has >= MARGIN_HAS_ALL && !(voxelLength(voxelDifference(nearest, near.moved)) > 0.0f);
}
#else
/// Whether what a cell `has` proves something opaque within the margin of a triangle; both are about the cell's middle.
EXACT bool marginCellProves(MarginSpace by, CertifiedItem item, MarginTriangle about, MarginNear near, int has, int x,
                            int y, int z) {
    if (has == 0) {
        return false;
    }
    PRECISE float wholeSlack = about.slack + marginCellRadius(by);
    const VoxelPoint nearest =
        voxelPoint(marginInCell(near.moved.x, x, item.sizeX), marginInCell(near.moved.y, y, item.sizeY),
                   marginInCell(near.moved.z, z, item.sizeZ));
#ifdef TURN
    const VoxelPoint lo = voxelPoint(marginInCell(-1.0f, x, item.sizeX), marginInCell(-1.0f, y, item.sizeY),
                                     marginInCell(-1.0f, z, item.sizeZ));
    const VoxelPoint hi = voxelPoint(marginInCell(1.0f, x, item.sizeX), marginInCell(1.0f, y, item.sizeY),
                                     marginInCell(1.0f, z, item.sizeZ));
    if (has >= MARGIN_HAS_ALL && marginInto(by, about.slack, near, voxelPoint(0.0f, 0.0f, 0.0f), lo, hi)) {
        return true;
    }
#endif
    return marginWithin(by, about.pivot, wholeSlack, near.at, voxelPoint(0.0f, 0.0f, 0.0f)) ||
           (has >= MARGIN_HAS_ALL && marginWithin(by, about.pivot, about.slack, near.at, nearest));
}
#endif

/// A look at a cell of a triangle, as a whole. `has`: of marginCellHas().
EXACT int marginCellLook(MarginSpace by, CertifiedItem item, CertifiedTriangle triangle, int has, int x, int y, int z) {
    PRECISE float middleX = float(x) + 0.5f;
    PRECISE float middleY = float(y) + 0.5f;
    PRECISE float middleZ = float(z) + 0.5f;
    const MarginTriangle about = marginTriangle(by, triangle, voxelPoint(middleX, middleY, middleZ), 0.5f);
    const MarginNear near = marginNear(by, about, voxelPoint(0.0f, 0.0f, 0.0f));
    if (marginBoxBeyond(by, about, near, voxelPoint(0.5f, 0.5f, 0.5f))) {
        return CERTIFIED_NONE;
    }
    return marginCellProves(by, item, about, near, has, x, y, z) ? CERTIFIED_CERTAIN : CERTIFIED_UNDECIDED;
}

#ifndef MOVE
/// Places that are looked at first: a vertex, and what is a little nearer to it than the margin along each axis.
#define MARGIN_PROBES 7

EXACT VoxelPoint marginProbe(MarginSpace by, VoxelPoint vertex, int probe) {
    if (probe == 0) {
        return vertex;
    }
    const int axis = (probe - 1) >> 1;
    const float side = axis == 0   ? marginSide(by.xx, 0.0f, 0.0f, 0.0f, 1.0f)
                       : axis == 1 ? marginSide(by.xy, by.yy, 0.0f, 0.0f, 1.0f)
                                   : marginSide(by.xz, by.yz, by.zz, 0.0f, 1.0f);
    PRECISE float way = by.margin * 0.984375f * marginInverse(side) * ((probe & 1) == 0 ? 1.0f : -1.0f);
    return voxelStep(vertex, voxelPoint(axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f),
                     way);
}

/// Whether such a place, in the cell that has its corner at `corner`, proves something opaque within the margin. The
/// vertex may be off by `delta`.
EXACT bool marginProbeProves(OpacityTable table, MarginSpace by, CertifiedCell cell, VoxelPoint vertex, VoxelPoint at,
                             VoxelPoint corner, float delta) {
    const VoxelPoint from = voxelDifference(vertex, corner);
    const VoxelPoint place = marginClamped(marginCellBox(cell), voxelDifference(at, corner));
    PRECISE float reach = voxelLength(from) + 1.0f;
    MarginSamples samples = marginNoSamples();
    const VoxelPoint pivot = voxelDifference(by.pivot, corner);
    return marginWithin(by, pivot, marginMovedSlack(by, pivot, delta, reach), from, place) &&
           marginPointProves(table, cell, place, samples);
}

/// Half the side of a brick, in voxels.
#define MARGIN_BRICK_RADIUS 4.0f

/// Whether a brick of stored values from `lo` to `hi` has something opaque. The two values are those of voxels in it,
/// and where no voxel is NaN the interpolant is continuous between them.
EXACT bool marginRangeHas(OpacityTable table, CertifiedItem item, float lo, float hi) {
    const float first = certifiedEntry(item, lo);
    const float second = certifiedEntry(item, hi);
    const float error = certifiedPointError(item, lo, hi);
    const float least = certifiedMin(first, second);
    const float greatest = certifiedMax(first, second);
    PRECISE float leastAbove = least + error;
    PRECISE float greatestBelow = greatest - error;
    PRECISE float leastBelow = least - error;
    PRECISE float greatestAbove = greatest + error;
    return certainlySomeOpaque(table, leastAbove, greatestBelow) ||
           certainlyAllOpaque(table, leastBelow, greatestAbove);
}

/// Whether such a brick has something opaque, and is within the margin of a vertex, all of it.
EXACT bool marginBrickProves(OpacityTable table, CertifiedItem item, MarginSpace by, VoxelPoint vertex, float delta,
                             VoxelPoint middle, float lo, float hi) {
    const VoxelPoint from = voxelDifference(vertex, middle);
    PRECISE float reach = voxelLength(from) + MARGIN_BRICK_RADIUS;
    const VoxelPoint pivot = voxelDifference(by.pivot, middle);
    const float slack = marginMovedSlack(by, pivot, delta, reach);
#ifdef TURN
    // What some turn brings within the margin is not convex: the corners do not say that all of the brick is.
    PRECISE float wholeSlack = slack + marginCellRadius(by) * (2.0f * MARGIN_BRICK_RADIUS);
    const bool all = marginWithin(by, pivot, wholeSlack, from, voxelPoint(0.0f, 0.0f, 0.0f));
#else
    bool all = true;
    for (int i = 0; i < 8; ++i) {
        const VoxelPoint corner = voxelPoint((i & 1) == 0 ? -MARGIN_BRICK_RADIUS : MARGIN_BRICK_RADIUS,
                                             (i & 2) == 0 ? -MARGIN_BRICK_RADIUS : MARGIN_BRICK_RADIUS,
                                             (i & 4) == 0 ? -MARGIN_BRICK_RADIUS : MARGIN_BRICK_RADIUS);
        all = all && marginWithin(by, pivot, slack, from, corner);
    }
#endif
    return all && marginRangeHas(table, item, lo, hi);
}
#endif

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
