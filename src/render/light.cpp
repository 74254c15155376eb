// SPDX-License-Identifier: MIT
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "render/matrix_rows.h"
#include "render/render_impl.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

using shader::PictureConstants;
using shader::vec4;

/// Depth of face shading, in voxels of the longest spacing.
constexpr double kFaceVoxels = 2;

double lengthOf(const Vec3& v) {
    return std::hypot(v[0], v[1], v[2]);
}

/// Converts a direction in the picture to world space: from one point of clip space to another.
Vec3 wayBetween(const Mat4& world_from_clip, const Vec3& from, const Vec3& to) {
    // Without divisions by w, like the shader: the far plane may be at infinity.
    const auto row = [&](const Vec3& clip, std::size_t i) {
        return world_from_clip[i] * clip[0] + world_from_clip[4 + i] * clip[1] + world_from_clip[8 + i] * clip[2] +
               world_from_clip[12 + i];
    };
    Vec3 way{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        way[axis] = row(to, axis) * row(from, 3) - row(from, axis) * row(to, 3);
    }
    const double length = lengthOf(way);
    for (double& x : way) {
        x = length > 0 ? x / length : 0;
    }
    return way;
}

/// Unit vector in world space; zero if the camera gives none.
Vec3 sideDirection(const Vec3& from, const Mat4& world_from_clip) {
    const Vec3 right = wayBetween(world_from_clip, {-1, 0, 0}, {1, 0, 0});
    const Vec3 up = wayBetween(world_from_clip, {0, 1, 0}, {0, -1, 0});
    const Vec3 forward = wayBetween(world_from_clip, {0, 0, 0}, {0, 0, 1});
    Vec3 side{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        side[axis] = from[0] * right[axis] + from[1] * up[axis] - from[2] * forward[axis];
    }
    const double length = lengthOf(side);
    for (double& x : side) {
        x = length > 0 ? x / length : 0;
    }
    return side;
}

vec4 floats(const Vec3& v, double w) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), static_cast<float>(w)};
}

} // namespace

Result<void> checkPositive(double value, const std::string& what) {
    return value > 0 && std::isnormal(static_cast<float>(value))
               ? Result<void>()
               : refuse(what + " is " + number(value) + ", not above 0, or beyond single precision");
}

Result<void> checkLighting(const Lighting& lighting) {
    for (const double value :
         {lighting.ambient, lighting.diffuse, lighting.specular, lighting.shininess, lighting.side}) {
        if (!(value >= 0 && value <= kMaxLight)) {
            return refuse("the lighting has a value of " + number(value) + ", outside [0, " + number(kMaxLight) + "]");
        }
    }
    if (!(lighting.occlusion >= 0 && lighting.occlusion <= 1)) {
        return refuse("the lighting has the occlusion " + number(lighting.occlusion) + ", outside [0, 1]");
    }
    if (lighting.occlusion > 0) {
        VOXTACT_TRY(checkPositive(lighting.reach, "the lighting's reach"));
    }
    const double length = lengthOf(lighting.sideFrom);
    if (lighting.side > 0 && !(length > 0 && std::isfinite(length))) {
        return refuse("the lighting's second light has no direction: sideFrom is zero or not finite");
    }
    return {};
}

Result<void> checkClipPlanes(std::span<const ClipPlane> planes) {
    if (planes.size() > kMaxClipPlanes) {
        return refuse("the scene has " + std::to_string(planes.size()) + " clip planes, the most is " +
                      std::to_string(kMaxClipPlanes));
    }
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const double length = lengthOf(planes[i].normal);
        if (!(length > 0) || !std::isfinite(length) || !std::isfinite(planes[i].offset / length)) {
            return refuse("clip plane " + std::to_string(i) + " is no plane: its normal is zero, or it is not finite");
        }
    }
    return {};
}

void setClipPlanes(PictureConstants& constants, const Scene& scene) {
    constants.planeCount = static_cast<int>(scene.clipPlanes.size());
    const Mat4 world_from_texture = worldFromTexture(scene.volume->grid());
    for (std::size_t i = 0; i < scene.clipPlanes.size(); ++i) {
        const ClipPlane& plane = scene.clipPlanes[i];
        const double length = lengthOf(plane.normal);
        const Vec3 normal{plane.normal[0] / length, plane.normal[1] / length, plane.normal[2] / length};
        const double offset = plane.offset / length;
        Vec3 inTexture{};
        double origin = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t row = 0; row < 3; ++row) {
                inTexture[axis] += normal[row] * world_from_texture[4 * axis + row];
            }
            origin += normal[axis] * world_from_texture[12 + axis];
        }
        constants.planes[i] = floats(normal, offset);
        constants.texturePlanes[i] = floats(inTexture, offset - origin);
    }
}

void setLight(PictureConstants& constants, const Scene& scene, const Mat4& world_from_clip) {
    const Lighting& lighting = scene.lighting;
    constants.light = {static_cast<float>(lighting.ambient), static_cast<float>(lighting.diffuse),
                       static_cast<float>(lighting.specular), static_cast<float>(lighting.shininess)};
    constants.side = floats(sideDirection(lighting.sideFrom, world_from_clip), lighting.side);
    constants.occlusion = static_cast<float>(lighting.occlusion);
    constants.reach = static_cast<float>(lighting.reach);
    constants.faceDepth = static_cast<float>(kFaceVoxels * *std::ranges::max_element(scene.volume->grid().spacing));
    constants.switches = (lighting.volume ? PICTURE_LIT_VOLUME : 0U) | (lighting.mesh ? PICTURE_LIT_MESH : 0U) |
                         (lighting.faces ? PICTURE_FACES : 0U) | (scene.jitter ? PICTURE_JITTER : 0U);
}

} // namespace voxtact
