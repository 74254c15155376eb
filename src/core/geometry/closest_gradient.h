// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/vec3.h"
#include "voxtact/distance.h"

namespace voxtact {

/// Sets the derivatives of the closest points' distance with respect to the pose. `way`: from the mesh's point to the
/// volume's; `arm`: from the object's origin to the mesh's point. World mm. The derivatives are 0 if both points
/// coincide.
inline void setGradient(WitnessPoints& closest, const Vec3& way, const Vec3& arm) {
    const double distance = length(way);
    if (!(distance > 0)) {
        return;
    }
    const Vec3 towards{way[0] / distance, way[1] / distance, way[2] / distance};
    const Vec3 turned = cross(arm, towards);
    closest.perTranslation = {-towards[0], -towards[1], -towards[2]};
    closest.perRotation = {-turned[0], -turned[1], -turned[2]};
}

} // namespace voxtact
