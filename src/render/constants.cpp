// SPDX-License-Identifier: MIT
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "render/matrix_rows.h"
#include "render/render_impl.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

using shader::PictureConstants;

constexpr double kMostSamples = 65536;

/// True if the near plane is at depth 1. Points nearer to an eye have the larger w of world_from_clip; an orthographic
/// camera has no eye, and looks towards larger depths.
bool isTurned(const Mat4& world_from_clip) {
    // w at depth 1 less w at depth 0, in the middle of the picture.
    return world_from_clip[11] > 0;
}

/// world_from_clip of the same camera with its near plane at depth 0.
Mat4 forwards(const Mat4& world_from_clip, bool turned) {
    constexpr Mat4 kTurnedDepth{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 1, 1};
    return turned ? multiply(world_from_clip, kTurnedDepth) : world_from_clip;
}

void setCamera(PictureConstants& constants, const VolumeImpl& volume, const Mat4& world_from_clip) {
    setRows(constants.world_from_clip, world_from_clip);
    setRows(constants.texture_from_clip, multiply(volume.texture_from_world, world_from_clip));
    setRows(constants.world_from_texture, linearPart(worldFromTexture(volume.grid)));
    setRows(constants.texture_from_world, linearPart(volume.texture_from_world));
}

void setFunction(PictureConstants& constants, const Scene& scene) {
    const VolumeImpl& volume = scene.volume->impl();
    const RenderTransferFunctionImpl& function = scene.transferFunction->impl();
    const double width = function.domain.hi - function.domain.lo;
    const double scale = volume.valueSlope / width;
    const double bias = (volume.valueIntercept - function.domain.lo) / width;
    const auto entries = static_cast<double>(function.table.size());
    const double ofStored = volume.storedUnit > 0 ? scale / volume.storedUnit : scale;
    constants.scalarScale = static_cast<float>(scale);
    constants.scalarBias = static_cast<float>(bias);
    constants.entryScale = static_cast<float>(ofStored * entries);
    constants.entryBias = static_cast<float>(bias * entries - 0.5);
    constants.step = static_cast<float>(function.step);
    constants.bricksX = scene.bricks != nullptr ? volume.brickCount[0] : 0;
    constants.bricksY = volume.brickCount[1];
    constants.tableSize = static_cast<int>(function.table.size());
}

/// A ray through the box must end.
Result<void> checkSamples(const Scene& scene) {
    const Grid& grid = scene.volume->grid();
    const Mat4 world_from_texture = worldFromTexture(grid);
    double longest = 0;
    for (const double y : {-1.0, 1.0}) {
        for (const double z : {-1.0, 1.0}) {
            Vec3 diagonal{};
            for (std::size_t row = 0; row < 3; ++row) {
                diagonal[row] =
                    world_from_texture[row] + y * world_from_texture[4 + row] + z * world_from_texture[8 + row];
            }
            longest = std::max(longest, std::hypot(diagonal[0], diagonal[1], diagonal[2]));
        }
    }
    const double step = scene.transferFunction->impl().step;
    if (longest / step > kMostSamples) {
        return refuse("the step of " + number(step) + " mm gives a ray through the volume, up to " + number(longest) +
                      " mm, more than " + number(kMostSamples) + " samples");
    }
    return {};
}

} // namespace

Result<void> checkColour(const Colour& colour, const char* what) {
    for (const double channel : colour) {
        if (!(channel >= 0 && channel <= 1)) {
            return refuse(std::string(what) + " has a channel of " + number(channel) + ", outside [0, 1]");
        }
    }
    return {};
}

Result<PictureSetup> setUpPicture(const Scene& scene, const Target& target) {
    const Result<Mat4> world_from_clip = inverse(scene.clip_from_world);
    if (!world_from_clip.ok()) {
        return refuse("the camera's clip_from_world cannot be used: " + world_from_clip.error().text);
    }
    for (const Result<void>& checked : {checkColour(scene.background, "the background"), checkLighting(scene.lighting),
                                        checkClipPlanes(scene.clipPlanes), checkSamples(scene)}) {
        VOXTACT_TRY(checked);
    }
    PictureSetup setup;
    setup.depthTurned = isTurned(*world_from_clip);
    PictureConstants& constants = setup.constants;
    const Mat4 forward = forwards(*world_from_clip, setup.depthTurned);
    setCamera(constants, scene.volume->impl(), forward);
    setFunction(constants, scene);
    setLight(constants, scene, forward);
    setClipPlanes(constants, scene);
    constants.viewport = {static_cast<float>(target.extent.width), static_cast<float>(target.extent.height), 0, 0};
    return setup;
}

} // namespace voxtact
