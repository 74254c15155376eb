// SPDX-License-Identifier: MIT
#include "bench/program/compare_inputs.h"

#include "bench/program/lab_run.h"
#include "cli/make/poses.h"
#include "cli/options/inputs.h"
#include "core/base/try.h"
#include "voxtact/io.h"

namespace voxtact::app {

using namespace lab;

namespace {

Result<void> choosePoses(const CompareOptions& options, lab::Scene& scene) {
    if (options.view.poses.empty()) {
        scene.poses = randomPoses(scene.volume->data.grid, scene.mesh->data.view(), options.number, options.seed);
        scene.posesFrom = "random, seed " + std::to_string(options.seed);
    } else {
        Result<std::vector<Mat4>> poses = loadPoses(options.view);
        VOXTACT_TRY(poses);
        scene.poses = std::move(*poses);
        scene.posesFrom = options.view.poses.string();
    }
    for (std::uint32_t i = 0; i < scene.poses.size(); ++i) {
        scene.poseNumbers.push_back(i);
    }
    if (!options.onlyPose) {
        return {};
    }
    const std::uint32_t only = *options.onlyPose;
    if (only >= scene.poses.size()) {
        return badArgument("--only-pose: there is no pose " + std::to_string(only) + "; the last is " +
                           std::to_string(scene.poses.size() - 1));
    }
    scene.poses = {scene.poses[only]};
    scene.poseNumbers = {only};
    return {};
}

Result<void> chooseCamera(const CompareOptions& options, lab::Scene& scene) {
    const VkExtent2D size = options.view.size;
    scene.view = {framingCamera(scene.volume->data.grid, size.width, size.height), size.width, size.height};
    if (options.view.camera.empty()) {
        return {};
    }
    const Result<Mat4> camera = io::readCamera(options.view.camera);
    VOXTACT_TRY(camera);
    scene.view.clip_from_world = *camera;
    return {};
}

} // namespace

Result<lab::Scene> readScene(const CompareOptions& options) {
    if (options.volumes.size() != 1 || options.meshes.sources.size() != 1) {
        return badArgument("--volume, --mesh: give each once");
    }
    Result<VolumePart> volume = loadVolumePart(options.volumes.front(), options.transferFunction);
    VOXTACT_TRY(volume);
    Result<MeshPart> mesh = loadMeshPart(options.meshes.sources.front(), options.meshes);
    VOXTACT_TRY(mesh);
    lab::Scene scene{
        std::make_shared<VolumePart>(std::move(*volume)), std::make_shared<MeshPart>(std::move(*mesh)), {}, {}, {}, {}};
    VOXTACT_TRY(chooseCamera(options, scene));
    VOXTACT_TRY(choosePoses(options, scene));
    return scene;
}

} // namespace voxtact::app
