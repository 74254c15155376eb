// SPDX-License-Identifier: MIT
// What certified_margin.h asks of a mesh that stays where it is; what each function says is there. One text for GLSL
// and C++.
#ifndef VOXTACT_CERTIFIED_MARGIN_STILL_H
#define VOXTACT_CERTIFIED_MARGIN_STILL_H

#include "certified_margin_space.h"

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

EXACT float marginMovedSlack(MarginSpace by, VoxelPoint, float delta, float reach) {
    return marginSlack(by, delta, reach);
}

EXACT VoxelPoint marginGrow(MarginSpace by, CertifiedReach) {
    return by.grow;
}

EXACT VoxelPoint marginWay(MarginSpace by, VoxelPoint, VoxelPoint near, VoxelPoint at) {
    return marginFlat(by, voxelDifference(at, near));
}

EXACT MarginTriangle marginLocal(MarginSpace, MarginTriangle about, float) {
    return about;
}

EXACT MarginNear marginNear(MarginSpace by, MarginTriangle triangle, VoxelPoint from) {
    VoxelPoint voxels[3] = {triangle.a, triangle.b, triangle.c};
    VoxelPoint corners[3];
    for (int i = 0; i < 3; ++i) {
        corners[i] = marginFlat(by, voxelDifference(voxels[i], from));
    }
    MarginNear near = marginNearest(voxels, corners);
    near.along = voxelPoint(-near.along.x, -near.along.y, -near.along.z);
    near.shadow = certifiedMax(voxelDot(near.along, corners[0]),
                               certifiedMax(voxelDot(near.along, corners[1]), voxelDot(near.along, corners[2])));
    return near;
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
