// SPDX-License-Identifier: MIT
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/geometry/pair_transform.h"
#include "core/geometry/recentre.h"
#include "render/matrix_rows.h"
#include "render/render_impl.h"

#include <algorithm>

namespace voxtact {

namespace {

Mat4 transposed(const Mat4& matrix) {
    Mat4 out{};
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 4; ++row) {
            out[4 * row + column] = matrix[4 * column + row];
        }
    }
    return out;
}

} // namespace

std::size_t meshCount(const Scene& scene) noexcept {
    return scene.others.size() + (scene.mesh != nullptr ? 1 : 0);
}

const SceneMesh& meshOf(const Scene& scene, std::size_t number) noexcept {
    if (scene.mesh == nullptr) {
        return scene.others[number];
    }
    return number == 0 ? static_cast<const SceneMesh&>(scene) : scene.others[number - 1];
}

Result<void> checkMeshLook(const SceneMesh& mesh) {
    VOXTACT_TRY(checkAffine(mesh.world_from_object, "the mesh's pose"));
    if (const Result<Mat4> object_from_world = inverse(linearPart(mesh.world_from_object)); !object_from_world.ok()) {
        return refuse("the mesh's pose cannot be used: " + object_from_world.error().text);
    }
    return checkColour(mesh.meshColour, "the mesh's colour");
}

shader::PictureMesh setUpMesh(const Scene& scene, const SceneMesh& mesh) {
    shader::PictureMesh constants{};
    // The camera unchanged: the paint is decided from the same numbers as by a detector.
    const Mat4 world_from_floats = worldFromFloats(mesh.world_from_object, mesh.mesh->impl().known.origin);
    const shader::PairTransform transform =
        pairTransform(scene.clip_from_world, world_from_floats, scene.volume->impl().texture_from_world);
    std::ranges::copy(transform.clip_from_object, constants.clip_from_object);
    std::ranges::copy(transform.texture_from_object, constants.texture_from_object);
    setRows(constants.world_from_object, world_from_floats);
    const Result<Mat4> object_from_world = inverse(linearPart(mesh.world_from_object));
    if (object_from_world.ok()) { // ensured by checkMeshLook()
        setRows(constants.normal_from_object, transposed(*object_from_world));
    }
    for (std::size_t channel = 0; channel < 3; ++channel) {
        constants.colour[channel] = static_cast<float>(mesh.meshColour[channel]);
    }
    constants.switches = mesh.clipped ? PICTURE_MESH_CLIPPED : 0U;
    setPaint(constants, *scene.volume, mesh.paint);
    return constants;
}

} // namespace voxtact
