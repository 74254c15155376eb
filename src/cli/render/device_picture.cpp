// SPDX-License-Identifier: MIT
#include "cli/render/device_picture.h"

#include "cli/output/interrupt.h"
#include "cli/output/progress.h"
#include "cli/output/standard_streams.h"
#include "cli/pairs/pair_run.h"
#include "core/base/try.h"

#include <algorithm>

namespace voxtact::app {

namespace {

/// Everything on the device, in the order in which it must end.
struct RenderObjects {
    BlockingRenderer renderer;
    Volume volume;
    RenderBricks bricks;
    RenderTransferFunction function;
    std::vector<Mesh> meshes{};
    std::vector<MeshNormals> normals{};
    ShowObjects show{};
};

Result<void> uploadMeshes(const RenderOptions& options, const RenderInputs& inputs, const device::Session& session,
                          RenderObjects& objects) {
    const QueueAccess queue = session.device.queueAccess();
    const Renderer& renderer = objects.renderer.renderer();
    for (const MeshData& data : inputs.meshes) {
        Result<Mesh> mesh = Mesh::upload(session.context, queue, data.view());
        VOXTACT_TRY(mesh);
        objects.meshes.push_back(std::move(*mesh));
        Result<MeshNormals> normals = MeshNormals::upload(renderer, queue, data.view());
        VOXTACT_TRY(normals);
        objects.normals.push_back(std::move(*normals));
    }
    const ShownPairs pairs{inputs.volume, inputs.meshes, inputs.poses, inputs.transferFunction(options),
                           options.transferFunction.threshold};
    Result<ShowObjects> show =
        makeShowObjects(options.show, pairs, inputs.distances, options.progress, session, renderer);
    VOXTACT_TRY(show);
    objects.show = std::move(*show);
    return {};
}

Result<RenderObjects> uploadObjects(const RenderOptions& options, const RenderInputs& inputs,
                                    const device::Session& session) {
    const QueueAccess queue = session.device.queueAccess();
    Result<BlockingRenderer> renderer = BlockingRenderer::create(session.context, queue);
    VOXTACT_TRY(renderer);
    RenderTransferFunctionDesc desc;
    desc.opacity = inputs.transferFunction(options);
    desc.colours = inputs.colours;
    desc.step = *std::ranges::min_element(inputs.volume.grid.spacing) / 2;
    Result<RenderTransferFunction> function = RenderTransferFunction::upload(renderer->renderer(), queue, desc);
    VOXTACT_TRY(function);
    Result<Volume> volume = Volume::upload(session.context, queue, inputs.volume.view(), {.bricks = true});
    VOXTACT_TRY(volume);
    Result<RenderBricks> bricks = RenderBricks::create(renderer->renderer(), *volume);
    VOXTACT_TRY(bricks);
    RenderObjects objects{std::move(*renderer), std::move(*volume), std::move(*bricks), std::move(*function)};
    VOXTACT_TRY(uploadMeshes(options, inputs, session, objects));
    return objects;
}

std::vector<SceneMesh> sceneMeshes(const RenderOptions& options, const RenderInputs& inputs,
                                   const RenderObjects& objects) {
    std::vector<SceneMesh> meshes;
    for (std::size_t mesh = 0; mesh < inputs.meshes.size(); ++mesh) {
        for (const Mat4& pose : inputs.poses) {
            SceneMesh one;
            one.mesh = &objects.meshes[mesh];
            one.normals = &objects.normals[mesh];
            one.world_from_object = pose;
            one.meshColour = meshColour(options, mesh);
            one.paint = paintOf(options.show, objects.show, options.transferFunction.threshold, meshes.size());
            one.clipped = options.clipMesh;
            meshes.push_back(one);
        }
    }
    return meshes;
}

} // namespace

Result<Picture> renderOn(const RenderOptions& options, const RenderInputs& inputs, const device::Session& session) {
    VOXTACT_TRY(checkViewport(options.view.size, session.context.maxViewport(), "the device"));
    Result<RenderObjects> objects = uploadObjects(options, inputs, session);
    VOXTACT_TRY(objects);
    if (!objects->function.visible()) {
        printNote("the transfer function has no opacity above 0: the volume is invisible");
    }
    const std::vector<SceneMesh> meshes = sceneMeshes(options, inputs, *objects);
    Scene scene;
    scene.volume = &objects->volume;
    scene.transferFunction = &objects->function;
    scene.bricks = &objects->bricks;
    scene.others = meshes;
    scene.clipPlanes = inputs.clips;
    scene.lighting = lightingNamed(options.lighting, inputs.volume.grid).value_or(Lighting{});
    scene.clip_from_world = inputs.clip_from_world;
    scene.background = options.background;
    Progress progress(options.progress, "rows of the picture", options.view.size.height);
    return objects->renderer.render(scene, options.view.size, [&](std::uint32_t rows, std::uint32_t) {
        progress.update(rows);
        return !interrupted();
    });
}

} // namespace voxtact::app
