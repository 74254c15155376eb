// SPDX-License-Identifier: MIT
// The projection `certified`: whether a triangle passes through a voxel cell, as far as that is clear without
// cutting the triangle. It meets a box where no axis separates them, of those of the box, the triangle's normal, and
// the nine at right angles to an edge of either (Akenine-Moeller, "Fast 3D triangle-box overlap testing", 2001). They
// are asked of a box somewhat smaller than the cell, and of a larger one; for what is between, there is
// certifiedClip().
#ifndef VOXTACT_CERTIFIED_OVERLAP_H
#define VOXTACT_CERTIFIED_OVERLAP_H

#include "certified.h"

/// In deltas of the triangle: by how much a cell is made smaller and larger on each side. A point of certifiedClip()
/// may be displaced by two. Rounding adds no more than two here: a place on an axis is off by less than 2^-20 of its
/// distance from the cell, which is at most a few voxels more than `reach`; and the delta is at least 2^-18 of that.
/// Edges are differences of corners, off by 2^-24 of each component, however short they are.
#define CERTIFIED_OVERLAP_MARGIN 8.0f
/// Voxels: triangles with a larger displacement stay open, and so all that reach 128 voxels.
#define CERTIFIED_OVERLAP_DELTA 0.00048828125f

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

/// Returns true if the test applies to a triangle.
EXACT bool certifiedOverlapMayBeAsked(CertifiedTriangle triangle) {
    return triangle.delta <= CERTIFIED_OVERLAP_DELTA;
}

/// Returns the distance beyond 1/2 where a triangle's projection onto an axis begins, relative to the axis' length. The
/// projection is from the minimum to the maximum of three places; `size` is the sum of the axis' components.
EXACT float certifiedShadowGap(float a, float b, float c, float size) {
    return certifiedShadowBegins(a, b, c) - 0.5f * size;
}

EXACT float certifiedOverlapMargin(float delta) {
    return CERTIFIED_OVERLAP_MARGIN * delta;
}

/// Applies one axis: a gap beyond the margin separates; a gap within the margin leaves the result of clipping open.
/// `margin` is for an axis whose `size` is 1.
EXACT void certifiedSeparate(float gap, float size, float margin, INOUT(bool) none, INOUT(bool) some) {
    const float most = margin * size;
    none = none || gap > most;
    some = some && gap <= -most;
}

/// Applies the three axes perpendicular to an edge of a triangle whose corners are relative to the cell's middle.
EXACT void certifiedSeparateByEdge(VoxelPoint edge, VoxelPoint a, VoxelPoint b, VoxelPoint c, float margin,
                                   INOUT(bool) none, INOUT(bool) some) {
    const float x = certifiedAbs(edge.x);
    const float y = certifiedAbs(edge.y);
    const float z = certifiedAbs(edge.z);
    certifiedSeparate(certifiedShadowGap(edge.z * a.y - edge.y * a.z, edge.z * b.y - edge.y * b.z,
                                         edge.z * c.y - edge.y * c.z, y + z),
                      y + z, margin, none, some);
    certifiedSeparate(certifiedShadowGap(edge.x * a.z - edge.z * a.x, edge.x * b.z - edge.z * b.x,
                                         edge.x * c.z - edge.z * c.x, z + x),
                      z + x, margin, none, some);
    certifiedSeparate(certifiedShadowGap(edge.y * a.x - edge.x * a.y, edge.y * b.x - edge.x * b.y,
                                         edge.y * c.x - edge.x * c.y, x + y),
                      x + y, margin, none, some);
}

EXACT bool certifiedInCell(VoxelPoint fromMiddle) {
    return voxelLength(fromMiddle) <= 0.5f;
}

/// Predicts whether certifiedClip() leaves a part of a triangle in the cell (x, y, z): CERTIFIED_CERTAIN,
/// CERTIFIED_NONE, or CERTIFIED_UNDECIDED if it must be clipped. Expects a cell that meets the triangle's box and lies
/// completely in the domain.
EXACT int certifiedOverlap(CertifiedTriangle triangle, int x, int y, int z) {
    if (!certifiedOverlapMayBeAsked(triangle)) {
        return CERTIFIED_UNDECIDED;
    }
    const VoxelPoint middle = voxelPoint(float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f);
    const VoxelPoint a = voxelDifference(triangle.corner0, middle);
    const VoxelPoint b = voxelDifference(triangle.corner1, middle);
    const VoxelPoint c = voxelDifference(triangle.corner2, middle);
    if (certifiedInCell(a) || certifiedInCell(b) || certifiedInCell(c)) {
        return CERTIFIED_CERTAIN; // it is not cut off there
    }
    bool none = false;
    bool some = true;
    const float margin = certifiedOverlapMargin(triangle.delta);
    certifiedSeparate(certifiedShadowGap(a.x, b.x, c.x, 1.0f), 1.0f, margin, none, some);
    certifiedSeparate(certifiedShadowGap(a.y, b.y, c.y, 1.0f), 1.0f, margin, none, some);
    certifiedSeparate(certifiedShadowGap(a.z, b.z, c.z, 1.0f), 1.0f, margin, none, some);
    certifiedSeparateByEdge(voxelDifference(b, a), a, b, c, margin, none, some);
    certifiedSeparateByEdge(voxelDifference(c, b), a, b, c, margin, none, some);
    certifiedSeparateByEdge(voxelDifference(a, c), a, b, c, margin, none, some);
    // Rounding may have turned the normal, like in certifiedPlaneMisses().
    const VoxelPoint normal = triangle.normal;
    const float size = certifiedAbs(normal.x) + certifiedAbs(normal.y) + certifiedAbs(normal.z);
    const float slack = triangle.reach * triangle.reach * (triangle.reach + 1.0f) * CERTIFIED_CLIP_ERROR;
    const float distance = certifiedAbs(normal.x * a.x + normal.y * a.y + normal.z * a.z);
    const float gap = distance - 0.5f * size;
    none = none || gap - slack > margin * size;
    some = some && gap + slack <= -margin * size;
    return none ? CERTIFIED_NONE : (some ? CERTIFIED_CERTAIN : CERTIFIED_UNDECIDED);
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
