// SPDX-License-Identifier: MIT
// What the caller records and submits: rings of results, edits of volumes, new transfer functions.
#include "scenarios.h"

namespace voxtact::test {

namespace {

constexpr std::uint32_t kFrames = 2;

/// What the frames of a story change before they ask.
using Change = std::function<void(Play&, Setting&, Embedder&, VkCommandBuffer, std::uint64_t frame)>;

/// Frames in flight: each changes the scene and asks, and is read while the next one is under way.
std::string ring(Play& play, const AnyDesc& desc, const Change& change) {
    Embedder embedder(play.stage());
    Setting setting(play);
    const Detector detector = play.ask("Detector::create", [&] { return Detector::create(setting.context, desc); });
    const ResultsDesc room{
        .maxPairs = 3, .room = {.triangles = 60, .labels = 1000, .contacts = 9}, .clustersAtOnce = 16};
    ResultRing results = play.ask("ResultRing::create", [&] { return ResultRing::create(detector, kFrames, room); });
    std::string answers;
    const auto read = [&](std::uint64_t frame) {
        answers += textOf(play.ask("ResultRing::read", [&] { return results.read(frame); }));
        BatchAnswer answer;
        play.ask("ResultRing::readOutputs", [&] { return results.readOutputs(frame, answer); });
        answers += textOf(answer);
    };
    for (std::uint64_t frame = 0; frame < 4; ++frame) {
        const std::vector<Mat4> poses = somePoses(3, 0.02 * static_cast<double>(frame));
        const BatchItem item = setting.item(poses);
        const VkCommandBuffer commands = embedder.begin();
        change(play, setting, embedder, commands, frame);
        Results* slot = play.ask("ResultRing::begin", [&] { return results.begin(frame); });
        play.ask("Detector::cmdDetect", [&] {
            return detector.cmdDetect(commands, {{&item, 1}, someView(), kThreshold}, *slot);
        });
        play.ask("Results::cmdReadBack", [&] { return slot->cmdReadBack(commands); });
        embedder.submit(commands);
        if (frame > 0) {
            embedder.wait();
            read(frame - 1);
        }
    }
    embedder.wait();
    read(3);
    return answers;
}

void edit(Play& play, Setting& setting, Embedder& embedder, VkCommandBuffer commands, std::uint64_t frame) {
    Volume& volume = setting.volume;
    switch (frame) {
    case 0:
        play.ask("Volume::cmdSet of a box", [&] {
            return volume.cmdSet(commands, VoxelBox{{1, 2, 3}, {3, 2, 4}}, 200);
        });
        break;
    case 1:
        play.ask("Volume::cmdSet of a ball", [&] { return volume.cmdSet(commands, Ball{{0.5, 0.5, 0.5}, 0.3}, 10); });
        break;
    case 2: {
        const std::vector<std::byte> voxels(24, std::byte{77});
        play.ask("Volume::cmdWrite", [&] { return volume.cmdWrite(commands, {{2, 2, 2}, {4, 3, 2}}, voxels); });
        break;
    }
    default: {
        const std::vector<std::byte> voxels(64, std::byte{99});
        const VkBuffer buffer = embedder.makeBuffer(std::span(voxels), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        play.ask("Volume::cmdCopy", [&] { return volume.cmdCopy(commands, {{0, 4, 1}, {4, 4, 4}}, buffer, 0); });
    }
    }
}

void update(Play& play, Setting& setting, Embedder&, VkCommandBuffer commands, std::uint64_t frame) {
    play.ask("TransferFunction::cmdUpdate",
             [&] { return setting.function.cmdUpdate(commands, ramp(150 + 20 * static_cast<double>(frame))); });
}

void bend(Play& play, Setting& setting, Embedder& embedder, VkCommandBuffer commands, std::uint64_t frame) {
    std::vector<double> positions = setting.meshData.positions;
    for (double& coordinate : positions) {
        coordinate *= 1 - 0.1 * static_cast<double>(frame);
    }
    if (frame % 2 == 0) {
        play.ask("Mesh::cmdUpdate", [&] { return setting.mesh.cmdUpdate(commands, positions); });
        return;
    }
    const VkBuffer buffer =
        embedder.makeBuffer(std::span<const float>(floatsOf(positions)), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    play.ask("Mesh::cmdCopy", [&] { return setting.mesh.cmdCopy(commands, buffer, 0); });
}

void nothing(Play&, Setting&, Embedder&, VkCommandBuffer, std::uint64_t) {}

/// Uploads that the caller submits.
std::string cmdUploads(Play& play) {
    Embedder embedder(play.stage());
    const Setting setting(play);
    Volume volume = play.ask(
        "Volume::create", [&] { return Volume::create(setting.context, setting.volumeData.view(), {.bricks = true}); });
    TransferFunction function =
        play.ask("TransferFunction::create", [&] { return TransferFunction::create(setting.context, ramp(222)); });
    Mesh mesh = play.ask("Mesh::create", [&] { return Mesh::create(setting.context, setting.meshData.view()); });
    const Detector detector = play.ask("Detector::create", [&] {
        return Detector::raster(setting.context, {.method = CountingMethod::Compute, .filter = Filter::Exact});
    });
    Results results =
        play.ask("Results::create", [&] { return Results::create(detector, {.maxPairs = 2, .timestamps = true}); });
    const VkCommandBuffer commands = embedder.begin();
    play.ask("Volume::cmdUpload", [&] { return volume.cmdUpload(commands); });
    play.ask("TransferFunction::cmdUpload", [&] { return function.cmdUpload(commands); });
    play.ask("Mesh::cmdUpload", [&] { return mesh.cmdUpload(commands); });
    const std::vector<Mat4> poses = somePoses(2, 0.05);
    const BatchItem item{&mesh, &volume, &function, poses};
    play.ask("Detector::cmdDetect", [&] {
        return detector.cmdDetect(commands, {{&item, 1}, someView(), kThreshold}, results);
    });
    play.ask("Results::cmdReadBack", [&] { return results.cmdReadBack(commands); });
    embedder.submit(commands);
    embedder.wait();
    volume.releaseStaging();
    function.releaseStaging();
    mesh.releaseStaging();
    std::string out = textOf(play.ask("Results::read", [&] { return results.read(); }));
    out += std::to_string(play.ask("Results::gpuMilliseconds", [&] { return results.gpuMilliseconds(); }) > 0);
    return out;
}

} // namespace

std::vector<Scenario> editScenarios() {
    constexpr Outputs kAll{.triangles = true, .contacts = true, .bounds = true, .labels = true};
    const auto story = [](const char* name, const AnyDesc& desc, const Change& change) {
        return Scenario{name, [=](Play& play) { return ring(play, desc, change); }};
    };
    const AnyDesc certified{.method = CountingMethod::Compute, .projection = Projection::Certified, .outputs = kAll};
    return {
        story("ring query", {.method = CountingMethod::Query}, nothing),
        story("ring atomic outputs", {.method = CountingMethod::Atomic, .outputs = kAll}, nothing),
        story("ring edits certified outputs", certified, edit),
        story("ring edits subgroup", {.method = CountingMethod::Subgroup}, edit),
        story("ring updates certified outputs", certified, update),
        story("ring updates query", {.method = CountingMethod::Query}, update),
        story("ring bends certified outputs", certified, bend),
        story("ring bends query", {.method = CountingMethod::Query}, bend),
        {"uploads recorded by the caller", cmdUploads},
    };
}

} // namespace voxtact::test
