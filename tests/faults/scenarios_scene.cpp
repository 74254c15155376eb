// SPDX-License-Identifier: MIT
// Contexts, uploads, and the caller's own objects.
#include "scenarios.h"

#include <algorithm>
#include <iterator>

namespace voxtact::test {

namespace {

constexpr AnyDesc kCertified{.method = CountingMethod::Compute, .projection = Projection::Certified};

/// What a detector says of a scene, while nothing fails.
std::string answerOf(Play& play, const Context& context, const BatchItem& item, const AnyDesc& desc) {
    BlockingDetector detector =
        play.quietly([&] { return BlockingDetector::create(context, desc, play.stage().queue); });
    return textOf(play.quietly([&] { return detector.detect({{&item, 1}, someView(), kThreshold}); }));
}

std::string makeContexts(Play& play) {
    const Context context = play.askFirst("Context::create", [&] { return Context::create(play.stage().context); });
    return std::to_string(context.methods().size());
}

/// The checks that need the device, of a volume and label map by themselves.
std::string upload(Play& play) {
    const Setting setting(play);
    const Stage& stage = play.stage();
    const VolumeData voxels = someVoxels(ScalarType::Int16);
    const Volume volume = play.ask("Volume::upload", [&] {
        return Volume::upload(setting.context, stage.queue, voxels.view(), {.bricks = true, .editable = true});
    });
    const TransferFunction function = play.ask(
        "TransferFunction::upload", [&] { return TransferFunction::upload(setting.context, stage.queue, ramp(200)); });
    const MeshData cube = makeCube(0.3, 0.8);
    const Mesh mesh = play.ask(
        "Mesh::upload", [&] { return Mesh::upload(setting.context, stage.queue, cube.view(), {.clusters = true}); });
    const LabelData data = play.quietly([&] { return makeLabels(setting.volumeData.view()); });
    const LabelMap labels =
        play.ask("LabelMap::upload", [&] { return LabelMap::upload(setting.context, stage.queue, data); });
    const std::vector<Mat4> poses = somePoses(2, 0);
    const BatchItem item{&mesh, &volume, &function, poses, &labels};
    return answerOf(play, setting.context, item, kCertified) +
           answerOf(play, setting.context, item,
                    {.method = CountingMethod::Atomic, .outputs = {.contacts = true, .labels = true}});
}

/// The bricks, the empty binding and the pass that fits clusters are made for the first object that needs them.
std::string uploadFirst(Play& play) {
    const Context context = play.quietly([&] { return Context::create(play.stage().context); });
    const VolumeData voxels = someVoxels();
    const Volume plain =
        play.ask("Volume::upload", [&] { return Volume::upload(context, play.stage().queue, voxels.view()); });
    const Volume bricks = play.ask("Volume::upload with bricks", [&] {
        return Volume::upload(context, play.stage().queue, voxels.view(), {.bricks = true});
    });
    const MeshData cube = makeCube(0.3, 0.8);
    const Mesh bends = play.ask("Mesh::upload of one that bends", [&] {
        return Mesh::upload(context, play.stage().queue, cube.view(), {.clusters = true, .editable = true});
    });
    return "made";
}

std::string wrap(Play& play) {
    const Stage& stage = play.stage();
    Embedder embedder(stage);
    const Setting setting(play);
    const VkImageView image =
        embedder.makeImage(VK_IMAGE_TYPE_3D, VK_FORMAT_R8_UNORM, {8, 8, 8}, setting.volumeData.voxels);
    Volume volume = play.ask("Volume::wrap", [&] {
        return Volume::wrap(setting.context, {.view = image,
                                              .format = VK_FORMAT_R8_UNORM,
                                              .grid = setting.volumeData.grid,
                                              .boundaryValues = {},
                                              .bricks = true});
    });
    const std::vector<float> table = sampleTable(ramp(180)).value();
    const VkImageView tableImage =
        embedder.makeImage(VK_IMAGE_TYPE_1D, VK_FORMAT_R32_SFLOAT, {32, 1, 1}, std::as_bytes(std::span(table)));
    const TransferFunction function = play.ask("TransferFunction::wrap", [&] {
        return TransferFunction::wrap(setting.context, {.view = tableImage, .domain = {0, 180}, .table = table});
    });
    constexpr VkBufferUsageFlags kUsage =
        VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const MeshData cube = makeCube(0.3, 0.8);
    const VkBuffer vertices = embedder.makeBuffer(std::span<const float>(floatsOf(cube.positions)), kUsage);
    const VkBuffer indices = embedder.makeBuffer(std::span(cube.indices), kUsage);
    Mesh mesh = play.ask("Mesh::wrap", [&] {
        return Mesh::wrap(setting.context, {.vertices = vertices,
                                            .vertexCount = static_cast<std::uint32_t>(cube.positions.size() / 3),
                                            .indices = indices,
                                            .triangleCount = static_cast<std::uint32_t>(cube.indices.size() / 3),
                                            .storage = true,
                                            .clusters = true,
                                            .shape = cube.view()});
    });
    const VkCommandBuffer commands = embedder.begin();
    play.ask("Mesh::cmdUpload", [&] { return mesh.cmdUpload(commands); });
    play.ask("Mesh::cmdRefit", [&] { return mesh.cmdRefit(commands); });
    play.ask("cmdUpdateBricks", [&] { return volume.cmdUpdateBricks(commands, {{0, 0, 0}, {8, 8, 8}}); });
    embedder.submit(commands);
    embedder.wait();
    const std::vector<Mat4> poses = somePoses(2, 0);
    const BatchItem item{&mesh, &volume, &function, poses};
    std::vector<float> matrices;
    for (const Mat4& pose : poses) {
        std::transform(pose.begin(), pose.end(), std::back_inserter(matrices),
                       [](double element) { return static_cast<float>(element); });
    }
    const VkBuffer poseBuffer =
        embedder.makeBuffer(std::span<const float>(matrices), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const PoseBuffer onDevice = play.ask(
        "PoseBuffer::wrap", [&] { return PoseBuffer::wrap(setting.context, {.buffer = poseBuffer, .count = 2}); });
    BatchItem moving = item;
    moving.world_from_object = {};
    moving.poses = &onDevice;
    AnyDesc byPoses = kCertified;
    byPoses.devicePoses = true;
    return answerOf(play, setting.context, item, kCertified) +
           answerOf(play, setting.context, item, {.method = CountingMethod::Query}) +
           answerOf(play, setting.context, moving, byPoses);
}

} // namespace

std::vector<Scenario> sceneScenarios() {
    return {{"context", makeContexts}, {"upload", upload}, {"first upload", uploadFirst}, {"wrap", wrap}};
}

} // namespace voxtact::test
