// SPDX-License-Identifier: MIT
// Pictures: blocking, and recorded by the caller.
#include "scenarios.h"
#include "voxtact/render.h"

namespace voxtact::test {

namespace {

constexpr std::uint32_t kPainted[] = {0, 3, 5};

RenderTransferFunctionDesc colours(double unit) {
    return {.opacity = ramp(), .colours = {}, .opacityUnit = unit, .step = 0.1};
}

Scene sceneOf(const Setting& setting, const RenderTransferFunction& function) {
    Scene scene;
    scene.volume = &setting.volume;
    scene.transferFunction = &function;
    scene.clip_from_world = someView().clip_from_world;
    scene.background = {0.2, 0.4, 0.6};
    return scene;
}

/// Pictures of two sizes, without a mesh and with one, smooth and painted in every way.
std::string blocking(Play& play) {
    const Setting setting(play);
    const QueueAccess& queue = play.stage().queue;
    BlockingRenderer blocking =
        play.ask("BlockingRenderer::create", [&] { return BlockingRenderer::create(setting.context, queue); });
    const Renderer& renderer = blocking.renderer();
    const RenderTransferFunction function = play.ask(
        "RenderTransferFunction::upload", [&] { return RenderTransferFunction::upload(renderer, queue, colours(1)); });
    const MeshNormals normals =
        play.ask("MeshNormals::upload", [&] { return MeshNormals::upload(renderer, queue, setting.meshData.view()); });
    const RenderBricks bricks =
        play.ask("RenderBricks::create", [&] { return RenderBricks::create(renderer, setting.volume); });
    const PaintedTriangles painted = play.ask("PaintedTriangles::upload", [&] {
        return PaintedTriangles::upload(renderer, queue, setting.mesh.triangles(), kPainted);
    });
    const std::vector<Colour> reds(setting.meshData.positions.size() / 3, Colour{1, 0, 0});
    const PaintedVertices coloured =
        play.ask("PaintedVertices::upload", [&] { return PaintedVertices::upload(renderer, queue, reds); });
    std::string pictures;
    Scene scene = sceneOf(setting, function);
    const auto render = [&](VkExtent2D extent) {
        pictures += textOf(play.ask("BlockingRenderer::render", [&] { return blocking.render(scene, extent); }).rgba);
    };
    render({8, 6});
    scene.mesh = &setting.mesh;
    scene.normals = &normals;
    scene.bricks = &bricks;
    render({8, 6});
    scene.paint = {.what = Paint::Triangles, .triangles = &painted};
    render({12, 4});
    scene.paint = {.what = Paint::Vertices, .vertices = &coloured};
    render({12, 4});
    scene.normals = nullptr;
    scene.paint = {.what = Paint::Contacts, .transferFunction = &setting.function};
    render({12, 4});
    return pictures;
}

/// The caller's command buffers and picture: two frames, a new function between them, and paint from a detector.
std::string recorded(Play& play) {
    constexpr VkExtent2D kExtent{8, 6};
    Embedder embedder(play.stage());
    const Setting setting(play);
    const Renderer renderer = play.ask("Renderer::create", [&] { return Renderer::create(setting.context); });
    RenderTargets targets = play.ask("RenderTargets::create", [&] { return RenderTargets::create(renderer, kExtent); });
    RenderTransferFunction function = play.ask("RenderTransferFunction::create",
                                               [&] { return RenderTransferFunction::create(renderer, colours(1)); });
    const Detector detector = play.quietly([&] {
        return Detector::raster(setting.context, {.method = CountingMethod::Atomic, .outputs = {.triangles = true}});
    });
    Results results = play.quietly([&] { return Results::create(detector, {.room = {.triangles = 12}}); });
    const PaintedTriangles painted =
        play.ask("PaintedTriangles::wrap", [&] { return PaintedTriangles::wrap(renderer, results.triangleMask()); });
    const VkImageView picture =
        embedder.makeImage(VK_IMAGE_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, {kExtent.width, kExtent.height, 1}, {});
    Scene scene = sceneOf(setting, function);
    scene.mesh = &setting.mesh;
    scene.paint = {.what = Paint::Triangles, .triangles = &painted};
    Target target;
    target.view = picture;
    target.extent = kExtent;
    target.layout = VK_IMAGE_LAYOUT_GENERAL;
    target.targets = &targets;
    std::string pictures;
    for (const double unit : {1.0, 3.0}) {
        const VkCommandBuffer commands = embedder.begin();
        play.ask("RenderTransferFunction::cmdUpdate", [&] { return function.cmdUpdate(commands, colours(unit)); });
        const std::vector<Mat4> poses = somePoses(1, 0.01 * unit);
        const BatchItem item = setting.item(poses);
        play.ask("Detector::cmdDetect", [&] {
            return detector.cmdDetect(commands, {{&item, 1}, someView(), kThreshold}, results);
        });
        play.ask("Renderer::cmdRender", [&] { return renderer.cmdRender(commands, scene, target); });
        embedder.submit(commands);
        embedder.wait();
        const std::vector<std::byte> pixels = embedder.readImage({kExtent.width, kExtent.height, 1});
        pictures.append(reinterpret_cast<const char*>(pixels.data()), pixels.size());
    }
    return pictures;
}

} // namespace

std::vector<Scenario> renderScenarios() {
    return {{"pictures", blocking}, {"pictures recorded by the caller", recorded}};
}

} // namespace voxtact::test
