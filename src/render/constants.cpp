// SPDX-License-Identifier: MIT
#include "core/pair_transform.h"
#include "core/table_extremes.h"
#include "core/text.h"
#include "render/render_impl.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

using shader::PictureConstants;
using shader::vec4;

constexpr double kMostSamples = 65536;

Error refuse(std::string text) {
    return {ErrorCode::InvalidArgument, 0, std::move(text)};
}

vec4 rowOf(const Mat4& matrix, std::size_t row) {
    return {static_cast<float>(matrix[row]), static_cast<float>(matrix[4 + row]), static_cast<float>(matrix[8 + row]),
            static_cast<float>(matrix[12 + row])};
}

template <std::size_t Rows> void setRows(vec4 (&rows)[Rows], const Mat4& matrix) {
    for (std::size_t row = 0; row < Rows; ++row) {
        rows[row] = rowOf(matrix, row);
    }
}

/// The part of an affine matrix that directions see.
Mat4 linearPart(Mat4 matrix) {
    matrix[12] = matrix[13] = matrix[14] = 0;
    return matrix;
}

Mat4 transposed(const Mat4& matrix) {
    Mat4 out{};
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 4; ++row) {
            out[4 * row + column] = matrix[4 * column + row];
        }
    }
    return out;
}

/// Whether the near plane is at depth 1. What is nearer to an eye has the larger w of world_from_clip; an orthographic
/// camera has none, and looks towards larger depths.
bool isTurned(const Mat4& world_from_clip) {
    // w at depth 1 less w at depth 0, in the middle of the picture.
    return world_from_clip[11] > 0;
}

/// world_from_clip of the same camera with its near plane at depth 0.
Mat4 forwards(const Mat4& world_from_clip, bool turned) {
    constexpr Mat4 kTurnedDepth{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 1, 1};
    return turned ? multiply(world_from_clip, kTurnedDepth) : world_from_clip;
}

Result<void> checkLighting(const Lighting& lighting) {
    for (const double value : {lighting.ambient, lighting.diffuse, lighting.specular, lighting.shininess}) {
        if (!(value >= 0) || !std::isfinite(value)) {
            return refuse("the lighting has a value of " + number(value) + ", which is not finite or below 0");
        }
    }
    return {};
}

Result<void> setMesh(PictureConstants& constants, const Scene& scene) {
    if (scene.mesh == nullptr) {
        return {};
    }
    if (Result<void> affine = checkAffine(scene.world_from_object, "the mesh's pose"); !affine.ok()) {
        return affine;
    }
    const Result<Mat4> object_from_world = inverse(linearPart(scene.world_from_object));
    if (!object_from_world.ok()) {
        return refuse("the mesh's pose cannot be used: " + object_from_world.error().text);
    }
    // The camera as it is, turned or not: what is painted is decided from these numbers, as a detector does.
    const shader::PairTransform transform =
        pairTransform(scene.clip_from_world, scene.world_from_object, scene.volume->impl().texture_from_world);
    std::ranges::copy(transform.clip_from_object, constants.clip_from_object);
    std::ranges::copy(transform.texture_from_object, constants.texture_from_object);
    setRows(constants.world_from_object, scene.world_from_object);
    setRows(constants.normal_from_object, transposed(*object_from_world));
    return {};
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
    constants.tableLevels = static_cast<int>(TableExtremes::levelsOf(function.table.size()));
}

/// A ray through the box must come to an end.
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

void setLook(PictureConstants& constants, const Scene& scene) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
        constants.meshColour[channel] = static_cast<float>(scene.meshColour[channel]);
    }
    const Lighting& lighting = scene.lighting;
    constants.light = {static_cast<float>(lighting.ambient), static_cast<float>(lighting.diffuse),
                       static_cast<float>(lighting.specular), static_cast<float>(lighting.shininess)};
    constants.switches = (lighting.volume ? PICTURE_LIT_VOLUME : 0U) | (lighting.mesh ? PICTURE_LIT_MESH : 0U) |
                         (scene.jitter ? PICTURE_JITTER : 0U);
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
    for (const Result<void>& checked :
         {checkColour(scene.background, "the background"), checkColour(scene.meshColour, "the mesh's colour"),
          checkLighting(scene.lighting), checkSamples(scene)}) {
        if (!checked.ok()) {
            return checked.error();
        }
    }
    PictureSetup setup;
    setup.depthTurned = isTurned(*world_from_clip);
    PictureConstants& constants = setup.constants;
    if (Result<void> set = setMesh(constants, scene); !set.ok()) {
        return set.error();
    }
    setCamera(constants, scene.volume->impl(), forwards(*world_from_clip, setup.depthTurned));
    setFunction(constants, scene);
    setLook(constants, scene);
    constants.viewport = {static_cast<float>(target.extent.width), static_cast<float>(target.extent.height), 0, 0};
    setPaint(setup, scene);
    return setup;
}

} // namespace voxtact
