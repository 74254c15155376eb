// SPDX-License-Identifier: MIT
// The projection `conservative` on the way: how far a mesh goes in half of a piece of its way, to both sides of the
// pose in its middle. One text for GLSL and C++.
//
// What is at p in voxel space goes along w(p) = turning (p - centre) + speed to one side and as far to the other: it is
// somewhere on the way from p - w to p + w, or off that by no more than `bend` times the length of w less what goes
// straight. All that is linear in p, so what of a body gets farthest along a direction is one of its corners.
#ifndef VOXTACT_CERTIFIED_MOVE_H
#define VOXTACT_CERTIFIED_MOVE_H

#include "certified_triangle.h"

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

/// Of half a piece; in voxels.
struct MoveWay {
    VoxelPoint turningX, turningY, turningZ; // rows
    VoxelPoint centre;
    VoxelPoint speed;
    VoxelPoint straight; // of the speed: what is not of turning
    float bend;
    float slack; // flat: how far any point may be from there besides
};

/// How far what is at so much from the centre goes.
EXACT VoxelPoint moveOf(MoveWay by, VoxelPoint arm) {
    PRECISE float x = by.turningX.x * arm.x + by.turningX.y * arm.y + by.turningX.z * arm.z + by.speed.x;
    PRECISE float y = by.turningY.x * arm.x + by.turningY.y * arm.y + by.turningY.z * arm.z + by.speed.y;
    PRECISE float z = by.turningZ.x * arm.x + by.turningZ.y * arm.y + by.turningZ.z * arm.z + by.speed.z;
    return voxelPoint(x, y, z);
}

/// The most that a component of a move differs by between two points that differ by `radius` along each axis, or less.
EXACT VoxelPoint moveSpread(MoveWay by, VoxelPoint radius) {
    PRECISE float x = certifiedAbs(by.turningX.x) * radius.x + certifiedAbs(by.turningX.y) * radius.y +
                      certifiedAbs(by.turningX.z) * radius.z;
    PRECISE float y = certifiedAbs(by.turningY.x) * radius.x + certifiedAbs(by.turningY.y) * radius.y +
                      certifiedAbs(by.turningY.z) * radius.z;
    PRECISE float z = certifiedAbs(by.turningZ.x) * radius.x + certifiedAbs(by.turningZ.y) * radius.y +
                      certifiedAbs(by.turningZ.z) * radius.z;
    return voxelPoint(x, y, z);
}

/// No coordinate that a move of what is no farther than `reach` from the centre is computed with is larger.
EXACT float moveReach(MoveWay by, float reach) {
    PRECISE float turning = voxelLength(moveSpread(by, voxelPoint(reach, reach, reach)));
    PRECISE float most = turning + voxelLength(by.speed) + voxelLength(by.straight);
    return most;
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif
