// SPDX-License-Identifier: MIT
// The projection `conservative`: whether a triangle has an opaque point in a voxel cell, decided with bounds. One text
// for GLSL and C++, in the manner of exact.h, so that device and host say the same of every fragment.
//
// Voxel space: u = t * n - 0.5 along each axis, t being the texture coordinate and n the voxels: voxel i's centre is at
// i, cell i reaches from i to i + 1, and the domain from -0.5 to n - 0.5. Along a triangle the trilinear interpolant of
// a cell is a polynomial of degree three in the barycentric coordinates: it stays within the range of its Bernstein
// coefficients (Farin, "Triangular Bernstein-Bezier patches", 1986), which are means of the interpolant at mixed
// coordinates of the corners (its polar form, Ramshaw, "Blossoming", 1987).
#ifndef VOXTACT_CERTIFIED_H
#define VOXTACT_CERTIFIED_H

#include "opacity_ranges.h"

#define CERTIFIED_NONE 0      // the triangle has no opaque point in the cell
#define CERTIFIED_CERTAIN 1   // it has one
#define CERTIFIED_UNDECIDED 2 // neither could be shown

/// A triangle that six planes clip has at most this many corners.
#define CERTIFIED_MAX_CORNERS 9
/// Bisecting the longest edge halves all of them within three steps: enough for a resolution of 2^-12.
#define CERTIFIED_STACK 48
/// Pieces of a fragment that are looked at before it is left undecided.
#define CERTIFIED_MAX_PIECES 2048
/// Of the longest side of a triangle, in voxels: how far clipping and moving to a cell's corner may shift its points.
#define CERTIFIED_CLIP_ERROR 3.814697265625e-6f
/// Of the largest terms of an entry coordinate: how far its computation may be off, interpolation included.
#define CERTIFIED_VALUE_ERROR 1.9073486328125e-6f
/// Beyond this many voxels of displacement nothing is certain.
#define CERTIFIED_MOST_DELTA 0.125f
/// Voxels. Farther than any image reaches, and than any vertex whose error is below CERTIFIED_MOST_DELTA.
#define CERTIFIED_FARTHEST 1.0e30f

#ifdef __cplusplus
#define EXACT inline
#define PRECISE
#define OUT(type) type&
#define INOUT(type) type&
#define ARRAY(type, name, count) type(&name)[count]
namespace voxtact::shader {
#else
#define EXACT
#define PRECISE precise
#define OUT(type) out type
#define INOUT(type) inout type
#define ARRAY(type, name, count) inout type name[count]
#endif

/// A point or a vector of voxel space.
struct VoxelPoint {
    float x, y, z;
};

EXACT float certifiedMin(float a, float b) {
    return b < a ? b : a;
}
EXACT float certifiedMax(float a, float b) {
    return b > a ? b : a;
}
EXACT float certifiedAbs(float a) {
    return a < 0.0f ? -a : a;
}

EXACT VoxelPoint voxelPoint(float x, float y, float z) {
    VoxelPoint point;
    point.x = x;
    point.y = y;
    point.z = z;
    return point;
}

EXACT VoxelPoint voxelDifference(VoxelPoint a, VoxelPoint b) {
    PRECISE float x = a.x - b.x;
    PRECISE float y = a.y - b.y;
    PRECISE float z = a.z - b.z;
    return voxelPoint(x, y, z);
}

EXACT float voxelAlong(VoxelPoint point, int axis) {
    return axis == 0 ? point.x : (axis == 1 ? point.y : point.z);
}

/// The largest component.
EXACT float voxelLength(VoxelPoint vector) {
    return certifiedMax(certifiedAbs(vector.x), certifiedMax(certifiedAbs(vector.y), certifiedAbs(vector.z)));
}

/// A vertex in voxel space, and how far it may be off along each axis.
struct CertifiedVertex {
    VoxelPoint point;
    float error;
};

/// A triangle in voxel space.
struct CertifiedTriangle {
    VoxelPoint corner0, corner1, corner2;
    VoxelPoint normal; // not a unit vector
    float reach;       // its longest side along an axis, and two voxels
    float delta;       // voxels by which its points, and pieces of it, may be displaced along each axis
};

/// The cells that a triangle may pass through.
struct CertifiedBounds {
    int firstX, firstY, firstZ; // inclusive; none: last < first
    int lastX, lastY, lastZ;
    float delta;
    bool usable; // false: delta is too large, or not a number, for any fragment to be decided
};

EXACT CertifiedVertex certifiedVertex(CertifiedPair pair, float x, float y, float z) {
    PRECISE float fromX = x - pair.reference[0];
    PRECISE float fromY = y - pair.reference[1];
    PRECISE float fromZ = z - pair.reference[2];
    CertifiedVertex vertex;
    vertex.point = voxelPoint(exactDot(pair.voxel_from_reference[0], fromX, fromY, fromZ),
                              exactDot(pair.voxel_from_reference[1], fromX, fromY, fromZ),
                              exactDot(pair.voxel_from_reference[2], fromX, fromY, fromZ));
    vertex.error = exactDot(pair.error, certifiedAbs(fromX), certifiedAbs(fromY), certifiedAbs(fromZ));
    return vertex;
}

/// The cells of an axis that a triangle from `lo` to `hi` may meet. NaN meets all.
EXACT void certifiedCells(float lo, float hi, float delta, int size, OUT(int) first, OUT(int) last) {
    PRECISE float from = lo - delta;
    PRECISE float to = hi + delta;
    const float end = float(size) - 0.5f;
    if (to < -0.5f || from > end) {
        first = 0;
        last = -1;
        return;
    }
    first = from >= 0.0f ? (from < float(size - 1) ? int(floor(from)) : size - 1) : -1;
    last = to < float(size - 1) ? (to >= 0.0f ? int(floor(to)) : -1) : size - 1;
}

EXACT CertifiedBounds certifiedBounds(CertifiedItem item, CertifiedVertex vertex0, CertifiedVertex vertex1,
                                      CertifiedVertex vertex2) {
    const VoxelPoint a = vertex0.point;
    const VoxelPoint b = vertex1.point;
    const VoxelPoint c = vertex2.point;
    const VoxelPoint lo = voxelPoint(certifiedMin(a.x, certifiedMin(b.x, c.x)), certifiedMin(a.y, certifiedMin(b.y, c.y)),
                                     certifiedMin(a.z, certifiedMin(b.z, c.z)));
    const VoxelPoint hi = voxelPoint(certifiedMax(a.x, certifiedMax(b.x, c.x)), certifiedMax(a.y, certifiedMax(b.y, c.y)),
                                     certifiedMax(a.z, certifiedMax(b.z, c.z)));
    const float side = voxelLength(voxelDifference(hi, lo));
    PRECISE float reach = side + 2.0f;
    PRECISE float shift = CERTIFIED_CLIP_ERROR * reach;
    PRECISE float error01 = vertex0.error + vertex1.error;
    PRECISE float error012 = error01 + vertex2.error;
    PRECISE float delta = certifiedMax(vertex0.error, certifiedMax(vertex1.error, vertex2.error)) + shift;
    // The sum is not finite where one of them is not: the maximum may pass over a NaN.
    delta = error012 <= CERTIFIED_FARTHEST ? delta : CERTIFIED_FARTHEST;
    CertifiedBounds bounds;
    bounds.delta = delta;
    bounds.usable = delta <= CERTIFIED_MOST_DELTA;
    certifiedCells(lo.x, hi.x, delta, item.sizeX, bounds.firstX, bounds.lastX);
    certifiedCells(lo.y, hi.y, delta, item.sizeY, bounds.firstY, bounds.lastY);
    certifiedCells(lo.z, hi.z, delta, item.sizeZ, bounds.firstZ, bounds.lastZ);
    return bounds;
}

/// A box of object space.
struct CertifiedBox {
    float loX, loY, loZ;
    float hiX, hiY, hiZ;
};

EXACT float certifiedFarther(float lo, float hi, float from) {
    return certifiedMax(certifiedAbs(lo - from), certifiedAbs(hi - from));
}

EXACT float certifiedExtent(vec4 row, VoxelPoint radius) {
    return certifiedAbs(row[0]) * radius.x + certifiedAbs(row[1]) * radius.y + certifiedAbs(row[2]) * radius.z;
}

/// The cells that the triangles in a box of object space may pass through: those of certifiedBounds() are among them,
/// and its delta is no larger.
EXACT CertifiedBounds certifiedBoxBounds(CertifiedItem item, CertifiedPair pair, CertifiedBox box) {
    // Halves first: the sum of two large floats may overflow.
    const VoxelPoint centre = voxelPoint(box.loX * 0.5f + box.hiX * 0.5f, box.loY * 0.5f + box.hiY * 0.5f,
                                         box.loZ * 0.5f + box.hiZ * 0.5f);
    const VoxelPoint radius = voxelPoint(certifiedMax(box.hiX - centre.x, centre.x - box.loX),
                                         certifiedMax(box.hiY - centre.y, centre.y - box.loY),
                                         certifiedMax(box.hiZ - centre.z, centre.z - box.loZ));
    const CertifiedVertex middle = certifiedVertex(pair, centre.x, centre.y, centre.z);
    // The farthest point's error; rounding of the centre and of the radius, and clipping, within its multiple.
    const VoxelPoint farthest =
        voxelPoint(certifiedFarther(box.loX, box.hiX, pair.reference[0]),
                   certifiedFarther(box.loY, box.hiY, pair.reference[1]),
                   certifiedFarther(box.loZ, box.hiZ, pair.reference[2]));
    const float error = exactDot(pair.error, farthest.x, farthest.y, farthest.z);
    const VoxelPoint extent = voxelPoint(certifiedExtent(pair.voxel_from_reference[0], radius),
                                         certifiedExtent(pair.voxel_from_reference[1], radius),
                                         certifiedExtent(pair.voxel_from_reference[2], radius));
    PRECISE float reach = 4.0f * voxelLength(extent) + 4.0f;
    PRECISE float shift = reach * CERTIFIED_CLIP_ERROR;
    PRECISE float delta = 4.0f * error + shift;
    delta = delta <= CERTIFIED_FARTHEST ? delta : CERTIFIED_FARTHEST;
    CertifiedBounds bounds;
    bounds.delta = delta;
    bounds.usable = delta <= CERTIFIED_MOST_DELTA;
    certifiedCells(middle.point.x - extent.x, middle.point.x + extent.x, delta, item.sizeX, bounds.firstX, bounds.lastX);
    certifiedCells(middle.point.y - extent.y, middle.point.y + extent.y, delta, item.sizeY, bounds.firstY, bounds.lastY);
    certifiedCells(middle.point.z - extent.z, middle.point.z + extent.z, delta, item.sizeZ, bounds.firstZ, bounds.lastZ);
    return bounds;
}

EXACT CertifiedTriangle certifiedTriangle(VoxelPoint a, VoxelPoint b, VoxelPoint c, float delta) {
    CertifiedTriangle triangle;
    triangle.corner0 = a;
    triangle.corner1 = b;
    triangle.corner2 = c;
    triangle.delta = delta;
    const VoxelPoint u = voxelDifference(b, a);
    const VoxelPoint v = voxelDifference(c, a);
    PRECISE float side = certifiedMax(voxelLength(u), certifiedMax(voxelLength(v), voxelLength(voxelDifference(c, b))));
    PRECISE float reach = side + 2.0f;
    triangle.reach = reach;
    PRECISE float uyvz = u.y * v.z;
    PRECISE float uzvy = u.z * v.y;
    PRECISE float uzvx = u.z * v.x;
    PRECISE float uxvz = u.x * v.z;
    PRECISE float uxvy = u.x * v.y;
    PRECISE float uyvx = u.y * v.x;
    PRECISE float nx = uyvz - uzvy;
    PRECISE float ny = uzvx - uxvz;
    PRECISE float nz = uxvy - uyvx;
    triangle.normal = voxelPoint(nx, ny, nz);
    return triangle;
}

/// Whether the triangle's plane certainly misses a cube of voxel space, given by its centre and radius, half its side. Only for
/// cubes that meet the cells of the triangle.
EXACT bool certifiedPlaneMisses(CertifiedTriangle triangle, VoxelPoint centre, float radius) {
    const VoxelPoint from = voxelDifference(centre, triangle.corner0);
    PRECISE float x = from.x * triangle.normal.x;
    PRECISE float y = from.y * triangle.normal.y;
    PRECISE float z = from.z * triangle.normal.z;
    PRECISE float xy = x + y;
    PRECISE float distance = xy + z;
    PRECISE float sizeXY = certifiedAbs(triangle.normal.x) + certifiedAbs(triangle.normal.y);
    PRECISE float size = sizeXY + certifiedAbs(triangle.normal.z);
    PRECISE float margin = radius + triangle.delta;
    PRECISE float extent = margin * size;
    // The plane is measured from corner 0, which is within `far` of the cube's centre. Each component of the normal is
    // off by less than 2^-21 reach^2, the sum of products by as much again.
    PRECISE float square = triangle.reach * triangle.reach;
    PRECISE float twice = radius + radius;
    PRECISE float far = triangle.reach + twice;
    PRECISE float cube = square * far;
    PRECISE float error = cube * CERTIFIED_CLIP_ERROR;
    PRECISE float most = extent + error;
    return certifiedAbs(distance) > most;
}

// ---- A triangle in a cell ----

/// A cell, its corners' scalars as entry coordinates, and what is certain of them.
struct CertifiedCell {
    float x000, x100, x010, x110, x001, x101, x011, x111; // the entry coordinate at corner (x, y, z)
    VoxelPoint lo, hi;         // the part of the cell in the domain, relative to the cell's corner: within [0, 1]
    VoxelPoint safeLo, safeHi; // points in this box are in the domain whatever their displacement
    float pointError;          // of an entry coordinate at a point of the cell
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

/// How far entry coordinates of stored values between `lo` and `hi` may be off: conversion and interpolation.
EXACT float certifiedPointError(CertifiedItem item, float lo, float hi) {
    PRECISE float below = lo - item.storedReference;
    PRECISE float above = hi - item.storedReference;
    const float farthest = certifiedMax(certifiedAbs(below), certifiedAbs(above));
    PRECISE float scaled = certifiedAbs(item.entryScale) * farthest;
    PRECISE float terms = scaled + certifiedAbs(item.entryBias);
    PRECISE float error = terms * CERTIFIED_VALUE_ERROR;
    return error;
}

/// What a displacement of two `delta` along each axis adds to it. No partial derivative of the interpolant is larger
/// than the range of the voxels around.
EXACT float certifiedMargin(CertifiedItem item, float pointError, float wideLo, float wideHi, float delta) {
    PRECISE float range = wideHi - wideLo;
    PRECISE float entries = certifiedAbs(item.entryScale) * range;
    PRECISE float shifted = entries * delta;
    PRECISE float part = shifted * 8.0f;
    PRECISE float margin = pointError + part;
    return margin;
}

/// The entry coordinate of a stored value.
EXACT float certifiedEntry(CertifiedItem item, float stored) {
    PRECISE float from = stored - item.storedReference;
    PRECISE float scaled = from * item.entryScale;
    PRECISE float entry = scaled + item.entryBias;
    return entry;
}

/// Clips a polygon to one side of a plane across an axis: point * sign >= limit * sign. Returns the corners left.
EXACT int certifiedClipPlane(ARRAY(VoxelPoint, corners, CERTIFIED_MAX_CORNERS), int count, int axis, float limit,
                             bool above) {
    VoxelPoint kept[CERTIFIED_MAX_CORNERS];
    int keptCount = 0;
    for (int i = 0; i < count; ++i) {
        const VoxelPoint here = corners[i];
        const VoxelPoint next = corners[i + 1 < count ? i + 1 : 0];
        const float placeHere = voxelAlong(here, axis);
        const float placeNext = voxelAlong(next, axis);
        PRECISE float distanceHere = above ? placeHere - limit : limit - placeHere;
        PRECISE float distanceNext = above ? placeNext - limit : limit - placeNext;
        const bool insideHere = distanceHere >= 0.0f;
        const bool insideNext = distanceNext >= 0.0f;
        if (insideHere && keptCount < CERTIFIED_MAX_CORNERS) {
            kept[keptCount++] = here;
        }
        if (insideHere != insideNext && keptCount < CERTIFIED_MAX_CORNERS) {
            // From inside to outside, whichever comes first.
            PRECISE float span = insideHere ? distanceHere - distanceNext : distanceNext - distanceHere;
            PRECISE float inner = insideHere ? distanceHere : distanceNext;
            PRECISE float weight = inner * exactReciprocal(span);
            const VoxelPoint from = insideHere ? here : next;
            const VoxelPoint to = insideHere ? next : here;
            kept[keptCount++] = voxelPoint(exactLerp(from.x, to.x, weight), exactLerp(from.y, to.y, weight),
                                           exactLerp(from.z, to.z, weight));
        }
    }
    for (int i = 0; i < keptCount; ++i) {
        corners[i] = kept[i];
    }
    return keptCount;
}

EXACT float certifiedClamp(float value, float lo, float hi) {
    return value >= lo ? (value <= hi ? value : hi) : lo;
}

/// The part of a triangle in a cell: a polygon whose points are displaced by less than twice the triangle's delta, in
/// `corners`, relative to the cell's corner and within the cell. Returns the number of corners; 0: the triangle does
/// not pass through the cell.
EXACT int certifiedClip(CertifiedTriangle triangle, CertifiedCell cell, VoxelPoint origin,
                        ARRAY(VoxelPoint, corners, CERTIFIED_MAX_CORNERS)) {
    corners[0] = voxelDifference(triangle.corner0, origin);
    corners[1] = voxelDifference(triangle.corner1, origin);
    corners[2] = voxelDifference(triangle.corner2, origin);
    int count = 3;
    for (int axis = 0; axis < 3; ++axis) {
        PRECISE float lo = voxelAlong(cell.lo, axis) - triangle.delta;
        PRECISE float hi = voxelAlong(cell.hi, axis) + triangle.delta;
        const float a = voxelAlong(corners[0], axis);
        const float b = voxelAlong(corners[1], axis);
        const float c = voxelAlong(corners[2], axis);
        const bool whole = count == 3 && a >= lo && b >= lo && c >= lo && a <= hi && b <= hi && c <= hi;
        if (!whole) {
            count = certifiedClipPlane(corners, count, axis, lo, true);
            count = certifiedClipPlane(corners, count, axis, hi, false);
        }
    }
    for (int i = 0; i < count; ++i) {
        corners[i] = voxelPoint(certifiedClamp(corners[i].x, cell.lo.x, cell.hi.x),
                                certifiedClamp(corners[i].y, cell.lo.y, cell.hi.y),
                                certifiedClamp(corners[i].z, cell.lo.z, cell.hi.z));
    }
    return count;
}

/// The interpolant at a point of the cell, as an entry coordinate.
EXACT float certifiedInterpolate(CertifiedCell cell, float x, float y, float z) {
    const float v00 = exactLerp(cell.x000, cell.x100, x);
    const float v10 = exactLerp(cell.x010, cell.x110, x);
    const float v01 = exactLerp(cell.x001, cell.x101, x);
    const float v11 = exactLerp(cell.x011, cell.x111, x);
    return exactLerp(exactLerp(v00, v10, y), exactLerp(v01, v11, y), z);
}

/// A piece of a fragment.
struct CertifiedPiece {
    VoxelPoint a, b, c;
};

/// The interpolant along a piece: at its corners, and the range of its Bernstein coefficients.
struct CertifiedRange {
    float atA, atB, atC;
    float lo, hi;
};

EXACT CertifiedRange certifiedRange(CertifiedCell cell, CertifiedPiece piece) {
    const VoxelPoint points[3] = {piece.a, piece.b, piece.c};
    float mixed[27]; // at x of point i, y of point j, z of point k: [i + 3 * j + 9 * k]
    for (int i = 0; i < 3; ++i) {
        const float v00 = exactLerp(cell.x000, cell.x100, points[i].x);
        const float v10 = exactLerp(cell.x010, cell.x110, points[i].x);
        const float v01 = exactLerp(cell.x001, cell.x101, points[i].x);
        const float v11 = exactLerp(cell.x011, cell.x111, points[i].x);
        for (int j = 0; j < 3; ++j) {
            const float v0 = exactLerp(v00, v10, points[j].y);
            const float v1 = exactLerp(v01, v11, points[j].y);
            for (int k = 0; k < 3; ++k) {
                mixed[i + 3 * j + 9 * k] = exactLerp(v0, v1, points[k].z);
            }
        }
    }
    CertifiedRange range;
    range.atA = mixed[0];
    range.atB = mixed[13];
    range.atC = mixed[26];
    range.lo = certifiedMin(range.atA, certifiedMin(range.atB, range.atC));
    range.hi = certifiedMax(range.atA, certifiedMax(range.atB, range.atC));
    const float third = 0.3333333432674407958984375f;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (i != j) {
                // Twice point i, once point j.
                PRECISE float two = mixed[j + 3 * i + 9 * i] + mixed[i + 3 * j + 9 * i];
                PRECISE float three = two + mixed[i + 3 * i + 9 * j];
                PRECISE float mean = three * third;
                range.lo = certifiedMin(range.lo, mean);
                range.hi = certifiedMax(range.hi, mean);
            }
        }
    }
    PRECISE float even = mixed[21] + mixed[7];
    PRECISE float evens = even + mixed[11];
    PRECISE float odd = mixed[5] + mixed[15];
    PRECISE float odds = odd + mixed[19];
    PRECISE float all = evens + odds;
    PRECISE float middle = all * 0.16666667163372039794921875f;
    range.lo = certifiedMin(range.lo, middle);
    range.hi = certifiedMax(range.hi, middle);
    return range;
}

/// Points of a fragment that are certainly in the domain: those with the least and the greatest entry coordinate.
struct CertifiedSamples {
    bool some;
    float lo, hi;
    VoxelPoint atLo, atHi;
};

EXACT bool certifiedSafe(CertifiedCell cell, VoxelPoint at) {
    return at.x >= cell.safeLo.x && at.x <= cell.safeHi.x && at.y >= cell.safeLo.y && at.y <= cell.safeHi.y &&
           at.z >= cell.safeLo.z && at.z <= cell.safeHi.z;
}

EXACT void certifiedSample(CertifiedCell cell, VoxelPoint at, float entry, INOUT(CertifiedSamples) samples) {
    if (!certifiedSafe(cell, at)) {
        return;
    }
    if (!samples.some || entry < samples.lo) {
        samples.lo = entry;
        samples.atLo = at;
    }
    if (!samples.some || entry > samples.hi) {
        samples.hi = entry;
        samples.atHi = at;
    }
    samples.some = true;
}

/// Whether the samples prove a touch: one of them is opaque, or an opaque scalar lies between two of them (the
/// triangle within the domain is connected and the interpolant continuous).
EXACT bool certifiedProof(OpacityTable table, CertifiedSamples samples, float margin) {
    if (!samples.some) {
        return false;
    }
    PRECISE float loBelow = samples.lo - margin;
    PRECISE float loAbove = samples.lo + margin;
    PRECISE float hiBelow = samples.hi - margin;
    PRECISE float hiAbove = samples.hi + margin;
    return certainlyAllOpaque(table, loBelow, loAbove) || certainlyAllOpaque(table, hiBelow, hiAbove) ||
           certainlySomeOpaque(table, loAbove, hiBelow);
}

/// A point on the way from one sample to the other that is as opaque as the table has between them: the witness.
EXACT VoxelPoint certifiedWitness(OpacityTable table, CertifiedCell cell, CertifiedSamples samples) {
    VoxelPoint from = samples.atLo;
    VoxelPoint to = samples.atHi;
    float entryFrom = samples.lo;
    float entryTo = samples.hi;
    const float last = float(table.size - 1);
    for (int step = 0; step < 24; ++step) {
        const float opacityFrom = opacityAt(table, opacityEntry(table, entryFrom, 0.0f));
        const float opacityTo = opacityAt(table, opacityEntry(table, entryTo, last));
        if (opacityFrom >= table.threshold || opacityTo >= table.threshold) {
            return opacityFrom >= opacityTo ? from : to;
        }
        const VoxelPoint middle = voxelPoint(exactLerp(from.x, to.x, 0.5f), exactLerp(from.y, to.y, 0.5f),
                                             exactLerp(from.z, to.z, 0.5f));
        const float entry = certifiedInterpolate(cell, middle.x, middle.y, middle.z);
        const bool lower = entry >= entryFrom && mayBeOpaque(table, entryFrom, entry);
        if (lower) {
            to = middle;
            entryTo = entry;
        } else {
            from = middle;
            entryFrom = entry;
        }
    }
    return from;
}

/// Whether no point of a piece is safe, because all lie beyond the same side of the box that is.
EXACT bool certifiedAllUnsafe(CertifiedCell cell, CertifiedPiece piece) {
    return certifiedMax(piece.a.x, certifiedMax(piece.b.x, piece.c.x)) < cell.safeLo.x ||
           certifiedMax(piece.a.y, certifiedMax(piece.b.y, piece.c.y)) < cell.safeLo.y ||
           certifiedMax(piece.a.z, certifiedMax(piece.b.z, piece.c.z)) < cell.safeLo.z ||
           certifiedMin(piece.a.x, certifiedMin(piece.b.x, piece.c.x)) > cell.safeHi.x ||
           certifiedMin(piece.a.y, certifiedMin(piece.b.y, piece.c.y)) > cell.safeHi.y ||
           certifiedMin(piece.a.z, certifiedMin(piece.b.z, piece.c.z)) > cell.safeHi.z;
}

/// Whether dividing a piece cannot make its answer clearer: it is no wider than its error and all of it was sampled, or
/// none of it can be.
EXACT bool certifiedHopeless(CertifiedCell cell, CertifiedPiece piece, CertifiedRange range) {
    PRECISE float width = range.hi - range.lo;
    const bool sampled =
        certifiedSafe(cell, piece.a) && certifiedSafe(cell, piece.b) && certifiedSafe(cell, piece.c);
    return (!(width > cell.margin) && sampled) || certifiedAllUnsafe(cell, piece);
}

EXACT VoxelPoint certifiedMiddle(VoxelPoint a, VoxelPoint b) {
    return voxelPoint(exactLerp(a.x, b.x, 0.5f), exactLerp(a.y, b.y, 0.5f), exactLerp(a.z, b.z, 0.5f));
}

/// Decides a fragment: the polygon of certifiedClip() in its cell. `witness` is set where it is certain.
EXACT int certifiedDecide(OpacityTable table, CertifiedCell cell, float resolution,
                          ARRAY(VoxelPoint, corners, CERTIFIED_MAX_CORNERS), int count, OUT(VoxelPoint) witness) {
    CertifiedPiece stack[CERTIFIED_STACK];
    CertifiedSamples samples;
    samples.some = false;
    samples.lo = 0.0f;
    samples.hi = 0.0f;
    samples.atLo = corners[0];
    samples.atHi = corners[0];
    witness = corners[0];
    int waiting = 0;
    for (int i = count - 2; i > 0; --i) {
        stack[waiting].a = corners[0];
        stack[waiting].b = corners[i];
        stack[waiting].c = corners[i + 1];
        ++waiting;
    }
    bool open = false;
    for (int pieces = 0; waiting > 0; ++pieces) {
        if (pieces == CERTIFIED_MAX_PIECES) {
            return CERTIFIED_UNDECIDED;
        }
        const CertifiedPiece piece = stack[--waiting];
        const CertifiedRange range = certifiedRange(cell, piece);
        PRECISE float lo = range.lo - cell.margin;
        PRECISE float hi = range.hi + cell.margin;
        if (!mayBeOpaque(table, lo, hi)) {
            continue;
        }
        certifiedSample(cell, piece.a, range.atA, samples);
        certifiedSample(cell, piece.b, range.atB, samples);
        certifiedSample(cell, piece.c, range.atC, samples);
        if (certifiedProof(table, samples, cell.margin)) {
            witness = certifiedWitness(table, cell, samples);
            return CERTIFIED_CERTAIN;
        }
        const float ab = voxelLength(voxelDifference(piece.b, piece.a));
        const float bc = voxelLength(voxelDifference(piece.c, piece.b));
        const float ca = voxelLength(voxelDifference(piece.a, piece.c));
        const float longest = certifiedMax(ab, certifiedMax(bc, ca));
        if (!(longest > resolution) || waiting + 2 > CERTIFIED_STACK || certifiedHopeless(cell, piece, range)) {
            open = true;
            continue;
        }
        CertifiedPiece first = piece;
        CertifiedPiece second = piece;
        if (ab >= bc && ab >= ca) {
            const VoxelPoint middle = certifiedMiddle(piece.a, piece.b);
            first.b = middle;
            second.a = middle;
        } else if (bc >= ca) {
            const VoxelPoint middle = certifiedMiddle(piece.b, piece.c);
            first.c = middle;
            second.b = middle;
        } else {
            const VoxelPoint middle = certifiedMiddle(piece.c, piece.a);
            first.a = middle;
            second.c = middle;
        }
        stack[waiting++] = first;
        stack[waiting++] = second;
    }
    return open ? CERTIFIED_UNDECIDED : CERTIFIED_NONE;
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
    certifiedDomain(x, item.sizeX, delta, cell.lo.x, cell.hi.x, cell.safeLo.x, cell.safeHi.x);
    certifiedDomain(y, item.sizeY, delta, cell.lo.y, cell.hi.y, cell.safeLo.y, cell.safeHi.y);
    certifiedDomain(z, item.sizeZ, delta, cell.lo.z, cell.hi.z, cell.safeLo.z, cell.safeHi.z);
    cell.pointError = certifiedPointError(item, corners.wideLo, corners.wideHi);
    cell.margin = certifiedMargin(item, cell.pointError, corners.wideLo, corners.wideHi, delta);
    return cell;
}

/// Whether some entry coordinate from `lo` to `hi` may be opaque, each of which may be off by `error`.
EXACT bool certifiedMayBeOpaque(OpacityTable table, float lo, float hi, float error) {
    PRECISE float below = lo - error;
    PRECISE float above = hi + error;
    return mayBeOpaque(table, below, above);
}

/// Whether some point of the cell may be opaque.
EXACT bool certifiedCellMayBeOpaque(OpacityTable table, CertifiedCell cell) {
    const float lo = certifiedMin(certifiedMin(certifiedMin(cell.x000, cell.x100), certifiedMin(cell.x010, cell.x110)),
                                  certifiedMin(certifiedMin(cell.x001, cell.x101), certifiedMin(cell.x011, cell.x111)));
    const float hi = certifiedMax(certifiedMax(certifiedMax(cell.x000, cell.x100), certifiedMax(cell.x010, cell.x110)),
                                  certifiedMax(certifiedMax(cell.x001, cell.x101), certifiedMax(cell.x011, cell.x111)));
    return certifiedMayBeOpaque(table, lo, hi, cell.pointError);
}

/// Whether some sample of stored values from `lo` to `hi` may be opaque: of a brick.
EXACT bool certifiedRangeMayBeOpaque(OpacityTable table, CertifiedItem item, float lo, float hi) {
    const float first = certifiedEntry(item, lo);
    const float second = certifiedEntry(item, hi);
    const float error = certifiedPointError(item, lo, hi);
    return certifiedMayBeOpaque(table, certifiedMin(first, second), certifiedMax(first, second), error);
}

/// The texture coordinate of a point of voxel space.
EXACT VoxelPoint certifiedTexture(CertifiedItem item, VoxelPoint point) {
    PRECISE float x = (point.x + 0.5f) * exactReciprocal(float(item.sizeX));
    PRECISE float y = (point.y + 0.5f) * exactReciprocal(float(item.sizeY));
    PRECISE float z = (point.z + 0.5f) * exactReciprocal(float(item.sizeZ));
    return voxelPoint(x, y, z);
}

/// The range of an axis that a triangle's part in a cell lies in, relative to the cell's corner.
EXACT void certifiedPart(float a, float b, float c, float delta, float cellLo, float cellHi, OUT(float) lo,
                         OUT(float) hi) {
    PRECISE float least = certifiedMin(a, certifiedMin(b, c)) - delta;
    PRECISE float greatest = certifiedMax(a, certifiedMax(b, c)) + delta;
    lo = certifiedClamp(least, cellLo, cellHi);
    hi = certifiedClamp(greatest, cellLo, cellHi);
}

/// Whether some point in the box of the triangle's part in the cell may be opaque: the interpolant is linear along each
/// axis, so its extremes in a box are at the corners.
EXACT bool certifiedPartMayBeOpaque(OpacityTable table, CertifiedTriangle triangle, CertifiedCell cell,
                                    VoxelPoint origin) {
    const VoxelPoint a = voxelDifference(triangle.corner0, origin);
    const VoxelPoint b = voxelDifference(triangle.corner1, origin);
    const VoxelPoint c = voxelDifference(triangle.corner2, origin);
    VoxelPoint lo;
    VoxelPoint hi;
    certifiedPart(a.x, b.x, c.x, triangle.delta, cell.lo.x, cell.hi.x, lo.x, hi.x);
    certifiedPart(a.y, b.y, c.y, triangle.delta, cell.lo.y, cell.hi.y, lo.y, hi.y);
    certifiedPart(a.z, b.z, c.z, triangle.delta, cell.lo.z, cell.hi.z, lo.z, hi.z);
    float least = 0.0f;
    float greatest = 0.0f;
    for (int side = 0; side < 2; ++side) {
        const float x = side == 0 ? lo.x : hi.x;
        const float v00 = exactLerp(cell.x000, cell.x100, x);
        const float v10 = exactLerp(cell.x010, cell.x110, x);
        const float v01 = exactLerp(cell.x001, cell.x101, x);
        const float v11 = exactLerp(cell.x011, cell.x111, x);
        const float lowLow = exactLerp(v00, v10, lo.y);
        const float lowHigh = exactLerp(v01, v11, lo.y);
        const float highLow = exactLerp(v00, v10, hi.y);
        const float highHigh = exactLerp(v01, v11, hi.y);
        const float p = exactLerp(lowLow, lowHigh, lo.z);
        const float q = exactLerp(lowLow, lowHigh, hi.z);
        const float r = exactLerp(highLow, highHigh, lo.z);
        const float s = exactLerp(highLow, highHigh, hi.z);
        const float smallest = certifiedMin(certifiedMin(p, q), certifiedMin(r, s));
        const float largest = certifiedMax(certifiedMax(p, q), certifiedMax(r, s));
        least = side == 0 ? smallest : certifiedMin(least, smallest);
        greatest = side == 0 ? largest : certifiedMax(greatest, largest);
    }
    return certifiedMayBeOpaque(table, least, greatest, cell.pointError);
}

/// A fragment's verdict. Expects a cell that may have an opaque point. `witness` is in voxel space, set where it is
/// certain.
EXACT int certifiedFragment(OpacityTable table, CertifiedItem item, CertifiedTriangle triangle, CertifiedCell cell, int x,
                            int y, int z, OUT(VoxelPoint) witness) {
    const VoxelPoint origin = voxelPoint(float(x), float(y), float(z));
    witness = origin;
    if (!certifiedPartMayBeOpaque(table, triangle, cell, origin)) {
        return CERTIFIED_NONE;
    }
    VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
    const int count = certifiedClip(triangle, cell, origin, polygon);
    if (count == 0) {
        return CERTIFIED_NONE;
    }
    VoxelPoint within;
    const int verdict = certifiedDecide(table, cell, item.resolution, polygon, count, within);
    witness = voxelPoint(origin.x + within.x, origin.y + within.y, origin.z + within.z);
    return verdict;
}

#ifdef __cplusplus
#undef EXACT
#undef PRECISE
#undef OUT
#undef INOUT
#undef ARRAY
} // namespace voxtact::shader
#endif

#endif
