// SPDX-License-Identifier: MIT
// The projection `certified`: a voxel cell with what is certain of its interpolant, and the part of a triangle in
// it.
#ifndef VOXTACT_CERTIFIED_CELL_H
#define VOXTACT_CERTIFIED_CELL_H

#include "certified_triangle.h"
#include "opaque_values.h"

/// Maximum corners of a triangle after clipping by six planes.
#define CERTIFIED_MAX_CORNERS 9
/// Error of a computed entry, interpolation included, relative to the largest entry.
#define CERTIFIED_VALUE_ERROR 1.9073486328125e-6f
/// Larger than any number that devices flush to zero.
#define CERTIFIED_LEAST_ENTRY 7.7037197775489436e-34f

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

/// A cell, the entries of its corners, and their error bounds.
struct CertifiedCell {
    float x000, x100, x010, x110, x001, x101, x011, x111; // the entry at corner (x, y, z)
    float least, greatest;                                // of these
    VoxelPoint lo, hi;         // the part of the cell in the domain, relative to the cell's corner: within [0, 1]
    VoxelPoint safeLo, safeHi; // points in this box are in the domain whatever their displacement
    float displacement;        // of a point, along each axis, at most
    float cornerError;         // of an entry at a corner, where it is compared with an end of the opaque values
    float pointError;          // of an entry at a point of the cell
    float margin;              // the same, the displacement of the point included
};

/// The part of cell `cell` of an axis that is in the domain, and the box in which a displaced point stays there.
EXACT void certifiedDomain(int cell, int size, float delta, OUT(float) lo, OUT(float) hi, OUT(float) safeLo,
                           OUT(float) safeHi) {
    PRECISE float twice = delta + delta;
    PRECISE float below = 0.5f + twice;
    PRECISE float above = 0.5f - twice;
    lo = cell < 0 ? 0.5f : 0.0f;
    hi = cell == size - 1 ? 0.5f : 1.0f;
    safeLo = cell < 0 ? below : -1.0f;
    safeHi = cell == size - 1 ? above : 2.0f;
}

/// Returns the error of the entry of a voxel: not 0 only for floats near zero.
EXACT float certifiedCornerError(CertifiedItem item) {
    return item.entryScale < 1.0f && item.storedReference == 0.0f ? CERTIFIED_LEAST_ENTRY : 0.0f;
}

/// Returns the error of entries of stored values between `lo` and `hi`: conversion and interpolation.
EXACT float certifiedPointError(CertifiedItem item, float lo, float hi) {
    PRECISE float below = lo - item.storedReference;
    PRECISE float above = hi - item.storedReference;
    const float farthest = certifiedMax(certifiedAbs(below), certifiedAbs(above));
    PRECISE float scaled = item.entryScale * farthest;
    PRECISE float part = scaled * CERTIFIED_VALUE_ERROR;
    PRECISE float error = part + certifiedCornerError(item);
    return error;
}

/// Returns the error that a displacement of two `delta` along each axis adds. The range of the surrounding voxels
/// bounds every partial derivative of the interpolant.
EXACT float certifiedMargin(CertifiedItem item, float pointError, float wideLo, float wideHi, float delta) {
    // Scaled before, as the range of floats may be more than a float.
    PRECISE float least = item.entryScale * wideLo;
    PRECISE float greatest = item.entryScale * wideHi;
    PRECISE float entries = greatest - least;
    PRECISE float shifted = entries * delta;
    PRECISE float part = shifted * 8.0f;
    PRECISE float margin = pointError + part;
    return margin;
}

/// Returns the entry of a stored value.
EXACT float certifiedEntry(CertifiedItem item, float stored) {
    PRECISE float from = stored - item.storedReference;
    PRECISE float entry = from * item.entryScale;
    return entry;
}

/// Returns the distance of a point inside a plane across an axis.
EXACT float certifiedInsideBy(VoxelPoint point, int axis, float limit, bool above) {
    const float place = voxelAlong(point, axis);
    PRECISE float distance = above ? place - limit : limit - place;
    return distance;
}

/// Returns the intersection of a plane and the edge from a corner inside to one outside, by their distances inside.
EXACT VoxelPoint certifiedCut(VoxelPoint from, VoxelPoint to, float inside, float outside) {
    PRECISE float span = inside - outside;
    PRECISE float weight = inside * exactReciprocal(span);
    return voxelPoint(exactLerp(from.x, to.x, weight), exactLerp(from.y, to.y, weight),
                      exactLerp(from.z, to.z, weight));
}

EXACT float certifiedClamp(float value, float lo, float hi) {
    return value >= lo ? (value <= hi ? value : hi) : lo;
}

#ifndef __cplusplus // as HANDED says
VoxelPoint halves[2 * CERTIFIED_MAX_CORNERS];
VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
#endif

/// Clips a polygon of `count` corners, which begins at `first` in `halves`, to one side of a plane across an axis.
/// Returns the number of remaining corners. If some are cut off, the rest is in the other half, at `first`, without a
/// copy. The loop reads each corner once: its index is only known at run time, and devices keep such arrays in memory.
EXACT int certifiedClipPlane(INOUT(int) first HANDED(VoxelPoint, halves, 2 * CERTIFIED_MAX_CORNERS), int count,
                             int axis, float limit, bool above) {
    float least = 0.0f;
    float greatest = -1.0f;
    for (int i = 0; i < count; ++i) {
        const float distance = certifiedInsideBy(halves[first + i], axis, limit, above);
        least = certifiedMin(least, distance);
        greatest = certifiedMax(greatest, distance);
    }
    if (!(least < 0.0f)) {
        return count;
    }
    if (!(greatest >= 0.0f)) {
        return 0;
    }
    const int left = CERTIFIED_MAX_CORNERS - first;
    int kept = 0;
    VoxelPoint here = halves[first];
    float distanceHere = certifiedInsideBy(here, axis, limit, above);
    for (int i = 0; i < count; ++i) {
        const VoxelPoint next = halves[first + (i + 1 < count ? i + 1 : 0)];
        const float distanceNext = certifiedInsideBy(next, axis, limit, above);
        const bool insideHere = distanceHere >= 0.0f;
        const bool insideNext = distanceNext >= 0.0f;
        if (insideHere && kept < CERTIFIED_MAX_CORNERS) {
            halves[left + kept++] = here;
        }
        if (insideHere != insideNext && kept < CERTIFIED_MAX_CORNERS) {
            // From inside to outside, whichever comes first.
            halves[left + kept++] =
                certifiedCut(insideHere ? here : next, insideHere ? next : here,
                             insideHere ? distanceHere : distanceNext, insideHere ? distanceNext : distanceHere);
        }
        here = next;
        distanceHere = distanceNext;
    }
    first = left;
    return kept;
}

/// The part of a triangle in a cell: a polygon whose points are displaced by less than twice the triangle's delta, in
/// `polygon`, relative to the cell's corner and within the cell. Returns the number of corners; 0: the triangle does
/// not pass through the cell.
EXACT int certifiedClip(CertifiedTriangle triangle, CertifiedCell cell,
                        VoxelPoint origin HANDED(VoxelPoint, polygon, CERTIFIED_MAX_CORNERS)) {
#ifdef __cplusplus
    VoxelPoint halves[2 * CERTIFIED_MAX_CORNERS];
#endif
    halves[0] = voxelDifference(triangle.corner0, origin);
    halves[1] = voxelDifference(triangle.corner1, origin);
    halves[2] = voxelDifference(triangle.corner2, origin);
    int first = 0;
    int count = 3;
    // Below and above along each axis. One call for all, because shader compilers inline every call of a long function.
    for (int side = 0; side < 6; ++side) {
        const int axis = side >> 1;
        const bool above = (side & 1) == 0;
        PRECISE float lo = voxelAlong(cell.lo, axis) - triangle.delta;
        PRECISE float hi = voxelAlong(cell.hi, axis) + triangle.delta;
        count = certifiedClipPlane(first HAND(halves), count, axis, above ? lo : hi, above);
    }
    UNKNOWN_ROUNDS for (int i = 0; i < count; ++i) {
        const VoxelPoint corner = halves[first + i];
        polygon[i] =
            voxelPoint(certifiedClamp(corner.x, cell.lo.x, cell.hi.x), certifiedClamp(corner.y, cell.lo.y, cell.hi.y),
                       certifiedClamp(corner.z, cell.lo.z, cell.hi.z));
    }
    return count;
}

/// Returns the interpolant at a point of the cell, as an entry.
EXACT float certifiedInterpolate(CertifiedCell cell, float x, float y, float z) {
    const float v00 = exactLerp(cell.x000, cell.x100, x);
    const float v10 = exactLerp(cell.x010, cell.x110, x);
    const float v01 = exactLerp(cell.x001, cell.x101, x);
    const float v11 = exactLerp(cell.x011, cell.x111, x);
    return exactLerp(exactLerp(v00, v10, y), exactLerp(v01, v11, y), z);
}

/// The stored values at the corners of a cell, and the range of those around its brick.
struct CertifiedCorners {
    float s000, s100, s010, s110, s001, s101, s011, s111; // at corner (x, y, z)
    float wideLo, wideHi;
};

EXACT CertifiedCell certifiedCell(CertifiedItem item, CertifiedCorners corners, int x, int y, int z, float delta) {
    CertifiedCell cell;
    cell.x000 = certifiedEntry(item, corners.s000);
    cell.x100 = certifiedEntry(item, corners.s100);
    cell.x010 = certifiedEntry(item, corners.s010);
    cell.x110 = certifiedEntry(item, corners.s110);
    cell.x001 = certifiedEntry(item, corners.s001);
    cell.x101 = certifiedEntry(item, corners.s101);
    cell.x011 = certifiedEntry(item, corners.s011);
    cell.x111 = certifiedEntry(item, corners.s111);
    cell.least = certifiedMin(certifiedMin(certifiedMin(cell.x000, cell.x100), certifiedMin(cell.x010, cell.x110)),
                              certifiedMin(certifiedMin(cell.x001, cell.x101), certifiedMin(cell.x011, cell.x111)));
    cell.greatest = certifiedMax(certifiedMax(certifiedMax(cell.x000, cell.x100), certifiedMax(cell.x010, cell.x110)),
                                 certifiedMax(certifiedMax(cell.x001, cell.x101), certifiedMax(cell.x011, cell.x111)));
    certifiedDomain(x, item.sizeX, delta, cell.lo.x, cell.hi.x, cell.safeLo.x, cell.safeHi.x);
    certifiedDomain(y, item.sizeY, delta, cell.lo.y, cell.hi.y, cell.safeLo.y, cell.safeHi.y);
    certifiedDomain(z, item.sizeZ, delta, cell.lo.z, cell.hi.z, cell.safeLo.z, cell.safeHi.z);
    cell.displacement = 2.0f * delta;
    cell.cornerError = certifiedCornerError(item);
    cell.pointError = certifiedPointError(item, corners.wideLo, corners.wideHi);
    cell.margin = certifiedMargin(item, cell.pointError, corners.wideLo, corners.wideHi, delta);
    return cell;
}

/// Returns true if an entry from `lo` to `hi` may be opaque, with errors of at most `error`.
EXACT bool certifiedMayBeOpaque(OpaqueValues opaque, float lo, float hi, float error) {
    PRECISE float below = lo - error;
    PRECISE float above = hi + error;
    return mayBeOpaque(opaque, below, above);
}

/// Returns true if a point of the cell may be opaque.
EXACT bool certifiedCellMayBeOpaque(OpaqueValues opaque, CertifiedCell cell) {
    return certifiedMayBeOpaque(opaque, cell.least, cell.greatest, cell.pointError);
}

/// Returns true if a sample of stored values from `lo` to `hi` may be opaque: of a brick.
EXACT bool certifiedRangeMayBeOpaque(OpaqueValues opaque, CertifiedItem item, float lo, float hi) {
    return certifiedMayBeOpaque(opaque, certifiedEntry(item, lo), certifiedEntry(item, hi),
                                certifiedPointError(item, lo, hi));
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
