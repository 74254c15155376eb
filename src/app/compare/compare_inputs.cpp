// SPDX-License-Identifier: MIT
#include "app/compare/compare_inputs.h"

#include "app/options/inputs.h"
#include "lab/random_poses.h"
#include "voxtact/io.h"

namespace voxtact::app {

namespace {

Result<void> choosePoses(const CompareOptions& options, CompareData& data) {
    if (options.view.poses.empty()) {
        data.poses = randomPoses(data.volume.grid, data.mesh.view(), options.count, options.seed);
        data.posesFrom = "random, seed " + std::to_string(options.seed);
    } else {
        Result<std::vector<Mat4>> poses = loadPoses(options.view.poses);
        if (!poses.ok()) {
            return poses.error();
        }
        data.poses = std::move(*poses);
        data.posesFrom = options.view.poses.string();
    }
    for (std::uint32_t i = 0; i < data.poses.size(); ++i) {
        data.poseNumbers.push_back(i);
    }
    if (!options.onlyPose) {
        return {};
    }
    const std::uint32_t only = *options.onlyPose;
    if (only >= data.poses.size()) {
        return badArgument("--only-pose: there is no pose " + std::to_string(only) + ", the last is " +
                           std::to_string(data.poses.size() - 1));
    }
    data.poses = {data.poses[only]};
    data.poseNumbers = {only};
    return {};
}

Result<void> chooseCamera(const CompareOptions& options, CompareData& data) {
    const VkExtent2D size = options.view.size;
    data.view = {framingCamera(data.volume.grid, size.width, size.height), size.width, size.height};
    if (options.view.camera.empty()) {
        return {};
    }
    const Result<Mat4> camera = io::readCamera(options.view.camera);
    if (!camera.ok()) {
        return camera.error();
    }
    data.view.clip_from_world = *camera;
    return {};
}

} // namespace

Result<CompareData> readCompareData(const CompareOptions& options) {
    if (options.volumes.size() != 1 || options.meshes.sources.size() != 1) {
        return badArgument("one --volume and one --mesh are needed, not several");
    }
    CompareData data;
    Result<std::vector<ControlPoint>> points = loadControlPoints(options.transferFunction);
    if (!points.ok()) {
        return points.error();
    }
    Result<VolumeData> volume = loadVolume(options.volumes.front());
    if (!volume.ok()) {
        return volume.error();
    }
    const Result<ValueRange> range = checkVolume(volume->view());
    if (!range.ok()) {
        return range.error();
    }
    Result<MeshData> mesh = loadMesh(options.meshes.sources.front(), options.meshes);
    if (!mesh.ok()) {
        return mesh.error();
    }
    data.domain = tableDomain(options.transferFunction, volume->type, *range);
    data.points = points->empty() ? defaultRamp(data.domain) : std::move(*points);
    data.tableSize = options.transferFunction.tableSize;
    data.threshold = options.transferFunction.threshold;
    data.volumeName = options.volumes.front();
    data.meshName = options.meshes.sources.front();
    data.volume = std::move(*volume);
    data.mesh = std::move(*mesh);
    if (Result<void> camera = chooseCamera(options, data); !camera.ok()) {
        return camera.error();
    }
    if (Result<void> poses = choosePoses(options, data); !poses.ok()) {
        return poses.error();
    }
    return data;
}

} // namespace voxtact::app
