// SPDX-License-Identifier: MIT
// A lost device is remembered: every later call that reaches it says so.
#include "bench/engines/localize.h"
#include "device/scene/scene_impl.h"
#include "driver/pretend_driver.h"
#include "scenarios.h"
#include "sweep.h"
#include "voxtact/render.h"

#include <gtest/gtest.h>

namespace voxtact::test {
namespace {

constexpr VkExtent2D kExtent{8, 6};
constexpr std::array<Colour, 3> kVertexColours{};

template <class Value> std::optional<ErrorCode> codeOf(const Result<Value>& result) {
    return result.ok() ? std::nullopt : std::optional(result.error().code);
}

/// Everything that is made before the device is lost.
struct Objects {
    explicit Objects(Play& play)
        : setting(play), queue(play.stage().queue),
          volume(play.quietly([&] { return Volume::create(setting.context, setting.volumeData.view()); })),
          function(play.quietly([&] { return TransferFunction::create(setting.context, ramp()); })),
          mesh(play.quietly([&] { return Mesh::create(setting.context, setting.meshData.view()); })),
          wrapped(play.quietly([&] { return Mesh::wrap(setting.context, clustersOf(setting.mesh)); })),
          labelData(play.quietly([&] { return makeLabels(setting.volumeData.view()); })),
          labels(play.quietly([&] { return LabelMap::create(setting.context, labelData); })),
          detector(play.quietly([&] { return Detector::create(setting.context, kDesc); })),
          blocking(play.quietly([&] { return BlockingDetector::create(setting.context, kDesc, queue); })),
          results(
              play.quietly([&] { return Results::create(detector, {.timestamps = true, .room = {.triangles = 12}}); })),
          trace(play.quietly([&] { return FragmentTrace::create(setting.context, Filter::Hardware, queue); })),
          localizer(play.quietly([&] { return Localizer::create(setting.context, Filter::Hardware, queue); })),
          pictures(play.quietly([&] { return BlockingRenderer::create(setting.context, queue); })),
          colours(play.quietly([&] { return RenderTransferFunction::create(renderer(), colourDesc()); })),
          targets(play.quietly([&] { return RenderTargets::create(renderer(), kExtent); })),
          normals(play.quietly([&] { return MeshNormals::create(renderer(), setting.meshData.view()); })),
          painted(play.quietly([&] { return PaintedTriangles::create(renderer(), 12, {}); })),
          vertices(play.quietly([&] { return PaintedVertices::create(renderer(), kVertexColours); })) {}

    [[nodiscard]] const Renderer& renderer() const { return pictures.renderer(); }
    /// The buffers of another mesh as a caller's.
    static WrappedMesh clustersOf(const Mesh& mesh) {
        WrappedMesh out;
        out.vertices = out.indices = mesh.impl().vertices;
        out.vertexCount = mesh.impl().vertexCount;
        out.indexOffset = mesh.impl().indexOffset;
        out.triangleCount = mesh.triangles();
        out.storage = out.clusters = true;
        return out;
    }
    static RenderTransferFunctionDesc colourDesc() { return {.opacity = ramp(), .step = 0.1}; }
    static constexpr RasterDesc kDesc{.method = CountingMethod::Atomic, .outputs = {.triangles = true}};

    Setting setting;
    QueueAccess queue;
    Volume volume;
    TransferFunction function;
    Mesh mesh;
    Mesh wrapped;
    LabelData labelData;
    LabelMap labels;
    Detector detector;
    BlockingDetector blocking;
    Results results;
    FragmentTrace trace;
    Localizer localizer;
    BlockingRenderer pictures;
    RenderTransferFunction colours;
    RenderTargets targets;
    MeshNormals normals;
    PaintedTriangles painted;
    PaintedVertices vertices;
};

/// A call by name, and what it answers.
struct NamedCall {
    const char* name;
    std::optional<ErrorCode> code;
};

/// The caller's own objects, for what wraps them.
struct Own {
    explicit Own(Embedder& embedder)
        : image(embedder.makeImage(VK_IMAGE_TYPE_3D, VK_FORMAT_R8_UNORM, {8, 8, 8}, someVoxels().voxels)),
          buffer(embedder.makeBuffer(std::span(kBytes), VK_BUFFER_USAGE_TRANSFER_SRC_BIT)), commands(embedder.begin()) {
    }
    static constexpr std::array<std::byte, 512> kBytes{};
    VkImageView image;
    VkBuffer buffer;
    VkCommandBuffer commands;
};

std::vector<NamedCall> sceneCalls(Objects& o, const Own& own) {
    const Context& context = o.setting.context;
    const VolumeView voxels = o.setting.volumeData.view();
    const MeshView mesh = o.setting.meshData.view();
    const VoxelBox box{{1, 1, 1}, {2, 2, 2}};
    Volume& edited = o.setting.volume;
    WrappedVolume wrapped;
    wrapped.view = own.image;
    wrapped.format = VK_FORMAT_R8_UNORM;
    wrapped.grid = voxels.grid;
    WrappedTransferFunction table;
    table.view = own.image;
    table.domain = {0, 255};
    WrappedMesh triangles;
    triangles.vertices = own.buffer;
    triangles.vertexCount = 3;
    triangles.triangleCount = 1;
    return {
        {"Volume::create", codeOf(Volume::create(context, voxels))},
        {"Volume::wrap", codeOf(Volume::wrap(context, wrapped))},
        {"Volume::upload", codeOf(Volume::upload(context, o.queue, voxels))},
        {"Volume::cmdUpload", codeOf(o.volume.cmdUpload(own.commands))},
        {"Volume::cmdUpdateBricks", codeOf(edited.cmdUpdateBricks(own.commands, box))},
        {"Volume::cmdSet", codeOf(edited.cmdSet(own.commands, box, 3))},
        {"Volume::cmdWrite", codeOf(edited.cmdWrite(own.commands, box, std::span(Own::kBytes).first(8)))},
        {"Volume::cmdCopy", codeOf(edited.cmdCopy(own.commands, box, own.buffer, 0))},
        {"TransferFunction::create", codeOf(TransferFunction::create(context, ramp()))},
        {"TransferFunction::wrap", codeOf(TransferFunction::wrap(context, table))},
        {"TransferFunction::upload", codeOf(TransferFunction::upload(context, o.queue, ramp()))},
        {"TransferFunction::cmdUpload", codeOf(o.function.cmdUpload(own.commands))},
        {"TransferFunction::cmdUpdate", codeOf(o.function.cmdUpdate(own.commands, ramp()))},
        {"Mesh::create", codeOf(Mesh::create(context, mesh))},
        {"Mesh::wrap", codeOf(Mesh::wrap(context, triangles))},
        {"Mesh::upload", codeOf(Mesh::upload(context, o.queue, mesh))},
        {"Mesh::cmdUpload", codeOf(o.mesh.cmdUpload(own.commands))},
        {"Mesh::cmdUpload of clusters", codeOf(o.wrapped.cmdUpload(own.commands))},
        {"Mesh::cmdUpdate", codeOf(o.setting.mesh.cmdUpdate(own.commands, mesh.positions))},
        {"Mesh::cmdCopy", codeOf(o.setting.mesh.cmdCopy(own.commands, own.buffer, 0))},
        {"Mesh::cmdRefit", codeOf(o.wrapped.cmdRefit(own.commands))},
        {"LabelMap::create", codeOf(LabelMap::create(context, o.labelData))},
        {"LabelMap::upload", codeOf(LabelMap::upload(context, o.queue, o.labelData))},
        {"LabelMap::cmdUpload", codeOf(o.labels.cmdUpload(own.commands))},
    };
}

std::vector<NamedCall> detectCalls(Objects& o, const Own& own) {
    const Context& context = o.setting.context;
    const std::vector<Mat4> poses = somePoses(1, 0);
    const BatchItem item = o.setting.item(poses);
    const Batch batch{{&item, 1}, someView(), kThreshold};
    BatchAnswer answer;
    return {
        {"Detector::create", codeOf(Detector::create(context, Objects::kDesc))},
        {"Detector::cmdDetect", codeOf(o.detector.cmdDetect(own.commands, batch, o.results))},
        {"BlockingDetector::create", codeOf(BlockingDetector::create(context, Objects::kDesc, o.queue))},
        {"BlockingDetector::detect", codeOf(o.blocking.detect(batch))},
        {"Results::create", codeOf(Results::create(o.detector, {}))},
        {"Results::cmdReadBack", codeOf(o.results.cmdReadBack(own.commands))},
        {"Results::read", codeOf(o.results.read())},
        {"Results::counters", codeOf(o.results.counters())},
        {"Results::readOutputs", codeOf(o.results.readOutputs(answer))},
        {"Results::gpuMilliseconds", codeOf(o.results.gpuMilliseconds())},
        {"ResultRing::create", codeOf(ResultRing::create(o.detector, 2, {}))},
        {"selfTest", codeOf(selfTest(context, o.queue))},
        {"FragmentTrace::create", codeOf(FragmentTrace::create(context, Filter::Hardware, o.queue))},
        {"FragmentTrace::survivors", codeOf(o.trace.survivors(batch))},
        {"Localizer::create", codeOf(Localizer::create(context, Filter::Hardware, o.queue))},
        {"Localizer::triangles", codeOf(o.localizer.triangles(batch, Localization::Polygon))},
    };
}

std::vector<NamedCall> renderCalls(Objects& o, const Own& own) {
    const Context& context = o.setting.context;
    const Renderer& renderer = o.renderer();
    const MeshView mesh = o.setting.meshData.view();
    const RenderTransferFunctionDesc colours = Objects::colourDesc();
    Scene scene;
    scene.volume = &o.setting.volume;
    scene.transferFunction = &o.colours;
    scene.clip_from_world = someView().clip_from_world;
    Target target;
    target.view = own.image;
    target.extent = kExtent;
    target.targets = &o.targets;
    return {
        {"Renderer::create", codeOf(Renderer::create(context))},
        {"Renderer::cmdRender", codeOf(renderer.cmdRender(own.commands, scene, target))},
        {"BlockingRenderer::create", codeOf(BlockingRenderer::create(context, o.queue))},
        {"BlockingRenderer::render", codeOf(o.pictures.render(scene, kExtent))},
        {"RenderTransferFunction::create", codeOf(RenderTransferFunction::create(renderer, colours))},
        {"RenderTransferFunction::upload", codeOf(RenderTransferFunction::upload(renderer, o.queue, colours))},
        {"RenderTransferFunction::cmdUpload", codeOf(o.colours.cmdUpload(own.commands))},
        {"RenderTransferFunction::cmdUpdate", codeOf(o.colours.cmdUpdate(own.commands, colours))},
        {"RenderTargets::create", codeOf(RenderTargets::create(renderer, kExtent))},
        {"MeshNormals::create", codeOf(MeshNormals::create(renderer, mesh))},
        {"MeshNormals::upload", codeOf(MeshNormals::upload(renderer, o.queue, mesh))},
        {"MeshNormals::cmdUpload", codeOf(o.normals.cmdUpload(own.commands))},
        {"MeshNormals::cmdUpdate", codeOf(o.normals.cmdUpdate(own.commands, mesh))},
        {"RenderBricks::create", codeOf(RenderBricks::create(renderer, o.setting.volume))},
        {"PaintedTriangles::create", codeOf(PaintedTriangles::create(renderer, 12, {}))},
        {"PaintedTriangles::upload", codeOf(PaintedTriangles::upload(renderer, o.queue, 12, {}))},
        {"PaintedTriangles::wrap", codeOf(PaintedTriangles::wrap(renderer, o.results.triangleMask()))},
        {"PaintedTriangles::cmdUpload", codeOf(o.painted.cmdUpload(own.commands))},
        {"PaintedVertices::create", codeOf(PaintedVertices::create(renderer, kVertexColours))},
        {"PaintedVertices::upload", codeOf(PaintedVertices::upload(renderer, o.queue, kVertexColours))},
        {"PaintedVertices::wrap", codeOf(PaintedVertices::wrap(renderer, o.results.triangleMask()))},
        {"PaintedVertices::cmdUpload", codeOf(o.vertices.cmdUpload(own.commands))},
    };
}

TEST(LostDevice, EveryLaterCallSaysSo) {
    std::size_t asked = 0;
    const Scenario scenario{"loss", [&](Play& play) {
                                Embedder embedder(play.stage());
                                Objects objects(play);
                                const Own own(embedder);
                                const auto lost = Results::create(objects.detector, {.room = {.triangles = 12}});
                                EXPECT_EQ(codeOf(lost), ErrorCode::DeviceLost);
                                EXPECT_TRUE(objects.setting.context.deviceLost());
                                for (const auto calls : {sceneCalls, detectCalls, renderCalls}) {
                                    for (const NamedCall& call : calls(objects, own)) {
                                        EXPECT_EQ(call.code, ErrorCode::DeviceLost) << call.name;
                                        ++asked;
                                    }
                                }
                                return std::string();
                            }};
    const Pass pass = playDry(scenario, Fault{0, VK_ERROR_DEVICE_LOST});
    for (const std::string& complaint : pass.complaints) {
        ADD_FAILURE() << complaint;
    }
    EXPECT_EQ(asked, 62U);
}

} // namespace
} // namespace voxtact::test
