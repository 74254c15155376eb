// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/shown/camera.h"
#include "voxtact/data.h"

#include <imgui.h>

namespace voxtact::view {

/// Maps world points to points of the window.
struct Onto {
    Mat4 clip_from_world;
    ImVec2 corner;
    ImVec2 size;

    [[nodiscard]] ImVec2 at(const Vec3& world) const {
        const Vec3 clip = transformPoint(clip_from_world, world);
        return {corner.x + static_cast<float>(clip[0] + 1) / 2 * size.x,
                corner.y + static_cast<float>(clip[1] + 1) / 2 * size.y};
    }
};

} // namespace voxtact::view
