// SPDX-License-Identifier: MIT
// The projection `certified`: points and triangles in voxel space, how far rounding may have moved them, and the
// cells that they may pass through.
//
// Voxel space: u = t * n - 0.5 along each axis, t being the texture coordinate and n the voxels: voxel i's centre is at
// i, cell i reaches from i to i + 1, and the domain from -0.5 to n - 0.5.
#ifndef VOXTACT_CERTIFIED_TRIANGLE_H
#define VOXTACT_CERTIFIED_TRIANGLE_H

#include "exact.h"

/// Maximum shift of a triangle's points by clipping and by moving to a cell's corner, relative to its longest side in
/// voxels.
#define CERTIFIED_CLIP_ERROR 3.814697265625e-6f
/// Voxels: maximum displacement of a decidable triangle.
#define CERTIFIED_MOST_DELTA 0.125f
/// Voxels. A vertex whose error is larger may be anywhere.
#define CERTIFIED_FARTHEST 1.0e30f

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
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

EXACT float voxelDot(VoxelPoint a, VoxelPoint b) {
    PRECISE float sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
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
    float reach;       // its longest side along an axis, plus two voxels
    float delta;       // voxels by which its points, and pieces of it, may be displaced along each axis
};

/// The cells that a triangle may pass through.
struct CertifiedBounds {
    int firstX, firstY, firstZ; // inclusive; none: last < first
    int lastX, lastY, lastZ;
    float delta;
    bool usable; // false: delta is too large or NaN, so no fragment can be decided
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

/// Returns the cells along an axis that a triangle from `lo` to `hi` may meet. NaN meets all.
EXACT void certifiedCells(float lo, float hi, float delta, int size, OUT(int) first, OUT(int) last) {
    PRECISE float from = lo - delta;
    PRECISE float to = hi + delta;
    const float end = float(size) - 0.5f;
    if (to < -0.5f || from > end) {
        first = 0;
        last = -1;
        return;
    }
    first = from >= 0.0f ? (from < float(size - 1) ? int(from) : size - 1) : -1;
    last = to < float(size - 1) ? (to >= 0.0f ? int(to) : -1) : size - 1;
}

/// A bounding box in voxel space, within `delta` along each axis.
struct CertifiedReach {
    VoxelPoint lo, hi;
    float delta;
};

EXACT CertifiedReach certifiedReach(CertifiedVertex vertex0, CertifiedVertex vertex1, CertifiedVertex vertex2) {
    const VoxelPoint a = vertex0.point;
    const VoxelPoint b = vertex1.point;
    const VoxelPoint c = vertex2.point;
    CertifiedReach found;
    found.lo = voxelPoint(certifiedMin(a.x, certifiedMin(b.x, c.x)), certifiedMin(a.y, certifiedMin(b.y, c.y)),
                          certifiedMin(a.z, certifiedMin(b.z, c.z)));
    found.hi = voxelPoint(certifiedMax(a.x, certifiedMax(b.x, c.x)), certifiedMax(a.y, certifiedMax(b.y, c.y)),
                          certifiedMax(a.z, certifiedMax(b.z, c.z)));
    const float side = voxelLength(voxelDifference(found.hi, found.lo));
    PRECISE float reach = side + 2.0f;
    PRECISE float shift = CERTIFIED_CLIP_ERROR * reach;
    PRECISE float error01 = vertex0.error + vertex1.error;
    PRECISE float error012 = error01 + vertex2.error;
    PRECISE float delta = certifiedMax(vertex0.error, certifiedMax(vertex1.error, vertex2.error)) + shift;
    // The sum is not finite if one of them is not; a maximum may ignore a NaN. Infinity meets all cells.
    found.delta = error012 <= CERTIFIED_FARTHEST ? delta : intBitsToFloat(0x7f800000);
    return found;
}

/// Returns the cells that the contents of the box may cross.
EXACT CertifiedBounds certifiedBoundsOf(CertifiedItem item, CertifiedReach reach) {
    CertifiedBounds bounds;
    bounds.delta = reach.delta;
    bounds.usable = reach.delta <= CERTIFIED_MOST_DELTA;
    certifiedCells(reach.lo.x, reach.hi.x, reach.delta, item.sizeX, bounds.firstX, bounds.lastX);
    certifiedCells(reach.lo.y, reach.hi.y, reach.delta, item.sizeY, bounds.firstY, bounds.lastY);
    certifiedCells(reach.lo.z, reach.hi.z, reach.delta, item.sizeZ, bounds.firstZ, bounds.lastZ);
    return bounds;
}

EXACT CertifiedBounds certifiedBounds(CertifiedItem item, CertifiedVertex vertex0, CertifiedVertex vertex1,
                                      CertifiedVertex vertex2) {
    return certifiedBoundsOf(item, certifiedReach(vertex0, vertex1, vertex2));
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

/// Returns bounds for the triangles in a box of object space: they contain certifiedReach() of each, and delta is an
/// upper bound.
EXACT CertifiedReach certifiedBoxReach(CertifiedPair pair, CertifiedBox box) {
    // Halves first: the sum of two large floats may overflow.
    const VoxelPoint centre =
        voxelPoint(box.loX * 0.5f + box.hiX * 0.5f, box.loY * 0.5f + box.hiY * 0.5f, box.loZ * 0.5f + box.hiZ * 0.5f);
    const VoxelPoint radius = voxelPoint(certifiedMax(box.hiX - centre.x, centre.x - box.loX),
                                         certifiedMax(box.hiY - centre.y, centre.y - box.loY),
                                         certifiedMax(box.hiZ - centre.z, centre.z - box.loZ));
    const CertifiedVertex middle = certifiedVertex(pair, centre.x, centre.y, centre.z);
    // The farthest point's error; rounding of the centre and of the radius, and clipping, within its multiple.
    const VoxelPoint farthest = voxelPoint(certifiedFarther(box.loX, box.hiX, pair.reference[0]),
                                           certifiedFarther(box.loY, box.hiY, pair.reference[1]),
                                           certifiedFarther(box.loZ, box.hiZ, pair.reference[2]));
    const float error = exactDot(pair.error, farthest.x, farthest.y, farthest.z);
    const VoxelPoint extent = voxelPoint(certifiedExtent(pair.voxel_from_reference[0], radius),
                                         certifiedExtent(pair.voxel_from_reference[1], radius),
                                         certifiedExtent(pair.voxel_from_reference[2], radius));
    PRECISE float reach = 4.0f * voxelLength(extent) + 4.0f;
    PRECISE float shift = reach * CERTIFIED_CLIP_ERROR;
    PRECISE float delta = 4.0f * error + shift;
    CertifiedReach found;
    found.delta = delta <= CERTIFIED_FARTHEST ? delta : intBitsToFloat(0x7f800000);
    found.lo = voxelPoint(middle.point.x - extent.x, middle.point.y - extent.y, middle.point.z - extent.z);
    found.hi = voxelPoint(middle.point.x + extent.x, middle.point.y + extent.y, middle.point.z + extent.z);
    return found;
}

/// The cells that the triangles in a box of object space may pass through: those of certifiedBounds() are among them,
/// and its delta is no larger.
EXACT CertifiedBounds certifiedBoxBounds(CertifiedItem item, CertifiedPair pair, CertifiedBox box) {
    return certifiedBoundsOf(item, certifiedBoxReach(pair, box));
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

/// Returns true if the triangle's plane certainly misses a cube of voxel space; `radius` is half its side. Only for
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

/// Like certifiedPlaneMisses(), for a box; `radius` holds half its sides.
EXACT bool certifiedPlaneMissesBox(CertifiedTriangle triangle, VoxelPoint centre, VoxelPoint radius) {
    const VoxelPoint normal = triangle.normal;
    const float distance = voxelDot(voxelDifference(centre, triangle.corner0), normal);
    const float extent = (radius.x + triangle.delta) * certifiedAbs(normal.x) +
                         (radius.y + triangle.delta) * certifiedAbs(normal.y) +
                         (radius.z + triangle.delta) * certifiedAbs(normal.z);
    const float far = triangle.reach + 2.0f * voxelLength(radius);
    return certifiedAbs(distance) > extent + triangle.reach * triangle.reach * far * CERTIFIED_CLIP_ERROR;
}

/// Returns the distance from 0 to the projection of three points onto an axis; negative if the projection contains 0.
EXACT float certifiedShadowBegins(float a, float b, float c) {
    const float least = certifiedMin(a, certifiedMin(b, c));
    const float greatest = certifiedMax(a, certifiedMax(b, c));
    return certifiedMax(least, -greatest);
}

/// Returns true if a triangle, with corners relative to a box's centre, is separated from the box by one of three axes:
/// those perpendicular to an edge and to an edge of the box.
EXACT bool certifiedEdgeMisses(VoxelPoint edge, VoxelPoint a, VoxelPoint b, VoxelPoint c, VoxelPoint radius) {
    const float x = certifiedAbs(edge.x);
    const float y = certifiedAbs(edge.y);
    const float z = certifiedAbs(edge.z);
    return certifiedShadowBegins(edge.z * a.y - edge.y * a.z, edge.z * b.y - edge.y * b.z,
                                 edge.z * c.y - edge.y * c.z) > radius.y * z + radius.z * y ||
           certifiedShadowBegins(edge.x * a.z - edge.z * a.x, edge.x * b.z - edge.z * b.x,
                                 edge.x * c.z - edge.z * c.x) > radius.z * x + radius.x * z ||
           certifiedShadowBegins(edge.y * a.x - edge.x * a.y, edge.y * b.x - edge.x * b.y,
                                 edge.y * c.x - edge.x * c.y) > radius.x * y + radius.y * x;
}

/// Returns true if such an axis certainly separates the triangle, and pieces displaced by its delta, from a box, like
/// certifiedPlaneMissesBox(). For large, thin triangles, whose box and plane meet far more. Any direction of an axis
/// gives a valid separation, so only positions on the axis have errors. Each is off by less than 2^-21 of the farthest
/// corner's distance, times the sum of the axis' components: the margin has eight times that, and what clipping does to
/// a piece.
EXACT bool certifiedEdgesMissBox(CertifiedTriangle triangle, VoxelPoint centre, VoxelPoint radius) {
    const VoxelPoint a = voxelDifference(triangle.corner0, centre);
    const VoxelPoint b = voxelDifference(triangle.corner1, centre);
    const VoxelPoint c = voxelDifference(triangle.corner2, centre);
    const float farthest = certifiedMax(voxelLength(a), certifiedMax(voxelLength(b), voxelLength(c)));
    const float more = triangle.delta + (farthest + triangle.reach) * CERTIFIED_CLIP_ERROR;
    const VoxelPoint margin = voxelPoint(radius.x + more, radius.y + more, radius.z + more);
    return certifiedEdgeMisses(voxelDifference(b, a), a, b, c, margin) ||
           certifiedEdgeMisses(voxelDifference(c, b), a, b, c, margin) ||
           certifiedEdgeMisses(voxelDifference(a, c), a, b, c, margin);
}

EXACT bool certifiedEdgesMiss(CertifiedTriangle triangle, VoxelPoint centre, float radius) {
    return certifiedEdgesMissBox(triangle, centre, voxelPoint(radius, radius, radius));
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
