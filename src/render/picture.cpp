// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "device/scene/mesh_layout.h"
#include "render/render_impl.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/submit.h"

namespace voxtact {

namespace {

Result<void> checkMeshParts(const ContextImpl& context, const SceneMesh& mesh) {
    if (mesh.mesh == nullptr) {
        return mesh.normals == nullptr ? Result<void>() : refuse("Scene::normals is given without a mesh");
    }
    if (&mesh.mesh->impl().context != &context) {
        return refuse("Scene::mesh belongs to another Context");
    }
    VOXTACT_TRY(checkVertexInput(mesh.mesh->impl(), "Scene::mesh"));
    if (mesh.normals == nullptr) {
        return {};
    }
    const MeshNormalsImpl& normals = mesh.normals->impl();
    const MeshImpl& drawn = mesh.mesh->impl();
    if (&normals.context != &context || (!drawn.wrapped() && drawn.vertexCount != normals.vertices)) {
        return refuse("Scene::normals is not of Scene::mesh");
    }
    if (normals.vertices < drawn.drawnVertices()) {
        return refuse("Scene::normals has " + std::to_string(normals.vertices) + " vertices, the wrapped mesh has " +
                      std::to_string(drawn.drawnVertices()));
    }
    return {};
}

struct Part {
    bool uploaded;
    const char* what;
};

Result<void> checkUploaded(std::initializer_list<Part> parts) {
    for (const Part& part : parts) {
        if (!part.uploaded) {
            return neverUploaded(part.what);
        }
    }
    return {};
}

/// For a mesh with consistent parts.
Result<void> checkMeshUploaded(const SceneMesh& mesh) {
    const MeshPaint& paint = mesh.paint;
    const PaintBy by = paintedBy(paint.what);
    return checkUploaded(
        {{mesh.mesh->impl().uploaded, "Scene::mesh"},
         {mesh.normals == nullptr || mesh.normals->impl().uploaded, "Scene::normals"},
         {by != PaintBy::Triangles || paint.triangles->impl().uploaded, "Scene::paint.triangles"},
         {by != PaintBy::Vertices || paint.vertices->impl().uploaded, "Scene::paint.vertices"},
         {by != PaintBy::Fragments || paint.transferFunction->impl().uploaded, "Scene::paint.transferFunction"}});
}

Result<void> checkMesh(const ContextImpl& context, const SceneMesh& mesh) {
    VOXTACT_TRY(checkMeshParts(context, mesh));
    VOXTACT_TRY(checkPaint(context, mesh));
    if (mesh.mesh == nullptr) {
        return checkColour(mesh.meshColour, "the mesh's colour");
    }
    VOXTACT_TRY(checkMeshUploaded(mesh));
    return checkMeshLook(mesh);
}

Result<void> checkMeshes(const ContextImpl& context, const Scene& scene) {
    VOXTACT_TRY(checkMesh(context, scene));
    for (std::size_t i = 0; i < scene.others.size(); ++i) {
        Result<void> checked = scene.others[i].mesh != nullptr ? checkMesh(context, scene.others[i])
                                                               : Result<void>(refuse("there is no mesh"));
        if (!checked.ok()) {
            Error error = checked.error();
            error.text = "Scene::others[" + std::to_string(i) + "]: " + error.text;
            return error;
        }
    }
    return {};
}

Result<void> checkScene(const ContextImpl& context, const Scene& scene) {
    if (scene.volume == nullptr || scene.transferFunction == nullptr) {
        return refuse("Scene::volume or transferFunction is null");
    }
    if (&scene.volume->impl().context != &context || &scene.transferFunction->impl().renderer.context != &context) {
        return refuse("Scene::volume or transferFunction belongs to another Context");
    }
    if (!scene.volume->impl().filtered) {
        return Error{ErrorCode::Unsupported, 0,
                     "Scene::volume: the device cannot filter its format linearly, as ray casting does"};
    }
    if (scene.bricks != nullptr && scene.bricks->impl().volume != &scene.volume->impl()) {
        return refuse("Scene::bricks is not of Scene::volume");
    }
    if (Result<void> checked = checkUploaded({{scene.volume->impl().uploaded, "Scene::volume"},
                                              {scene.transferFunction->impl().uploaded, "Scene::transferFunction"}});
        !checked.ok()) {
        return checked;
    }
    if (scene.bricks != nullptr && !scene.volume->impl().bricksFilled) {
        return Error{ErrorCode::NotReady, 0,
                     "Scene::bricks were never filled: record Volume::cmdUpdateBricks() of the whole grid first"};
    }
    return checkMeshes(context, scene);
}

/// The whole picture without an area.
VkRect2D areaOf(const Target& target) {
    const VkRect2D& area = target.area;
    const bool whole = area.extent.width == 0 && area.extent.height == 0 && area.offset.x == 0 && area.offset.y == 0;
    return whole ? VkRect2D{{0, 0}, target.extent} : area;
}

bool isWithin(std::uint32_t from, std::uint32_t length, std::uint32_t whole) {
    return length > 0 && from < whole && length <= whole - from;
}

Result<void> checkTarget(const ContextImpl& context, const Target& target) {
    if (target.view == VK_NULL_HANDLE || target.targets == nullptr) {
        return refuse("Target::view or targets is null");
    }
    if (&target.targets->impl().renderer.context != &context) {
        return refuse("Target::targets belongs to another Context");
    }
    const VkExtent2D most = target.targets->extent();
    if (target.extent.width == 0 || target.extent.height == 0 || target.extent.width > most.width ||
        target.extent.height > most.height) {
        return refuse("Target::extent is empty, or beyond that of Target::targets");
    }
    if (target.layout != VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL && target.layout != VK_IMAGE_LAYOUT_GENERAL) {
        return refuse("Target::layout is neither COLOR_ATTACHMENT_OPTIMAL nor GENERAL");
    }
    const VkRect2D area = areaOf(target);
    if (area.offset.x < 0 || area.offset.y < 0 ||
        !isWithin(static_cast<std::uint32_t>(area.offset.x), area.extent.width, target.extent.width) ||
        !isWithin(static_cast<std::uint32_t>(area.offset.y), area.extent.height, target.extent.height)) {
        return refuse("Target::area is empty, or not in Target::extent");
    }
    return {};
}

void cmdVolumePass(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const Scene& scene,
                   const Target& target, VkRect2D area) {
    const DeviceFunctions& vk = renderer.context.vk;
    const VkRenderingAttachmentInfo colour =
        renderAttachment(target.view, target.layout, VK_ATTACHMENT_LOAD_OP_DONT_CARE);
    beginRendering(renderer.context, commandBuffer, target.extent, area, {&colour, 1}, nullptr, false);
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS,
                       renderer.volumePipelines[scene.lighting.occlusion > 0 ? 1 : 0].get());
    vk.CmdDraw(commandBuffer, 3, 1, 0, 0);
    vk.CmdEndRendering(commandBuffer);
}

void bindVolumeSets(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const Scene& scene,
                    const Target& target) {
    const VkDescriptorSet sets[] = {scene.volume->impl().descriptors.set, scene.transferFunction->impl().reading.set,
                                    target.targets->impl().descriptors.set,
                                    scene.bricks != nullptr ? scene.bricks->impl().descriptors.set
                                                            : renderer.noBricks.set};
    renderer.context.vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS,
                                              renderer.pictureLayout.get(), 0, std::size(sets), sets, 0, nullptr);
}

void writeTimestamp(const ContextImpl& context, VkCommandBuffer commandBuffer, const Target& target,
                    std::uint32_t number) {
    if (target.timestamps != VK_NULL_HANDLE) {
        context.vk.CmdWriteTimestamp2(commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, target.timestamps,
                                      target.firstTimestamp + number);
    }
}

} // namespace

Result<void> Renderer::cmdRender(VkCommandBuffer commandBuffer, const Scene& scene, const Target& target) const {
    return guard([&]() -> Result<void> {
        ContextImpl& context = live(impl_).context;
        VOXTACT_TRY(context.recordable(commandBuffer));
        VOXTACT_TRY(checkScene(context, scene));
        VOXTACT_TRY(checkTarget(context, target));
        const Result<PictureSetup> setup = setUpPicture(scene, target);
        VOXTACT_TRY(setup);
        const Label label(context, commandBuffer, "voxtact picture");
        writeTimestamp(context, commandBuffer, target, 0);
        const VkRect2D area = areaOf(target);
        cmdMeshPass(live(impl_), commandBuffer, scene, *setup, target, area);
        writeTimestamp(context, commandBuffer, target, 1);
        bindVolumeSets(live(impl_), commandBuffer, scene, target);
        cmdVolumePass(live(impl_), commandBuffer, scene, target, area);
        writeTimestamp(context, commandBuffer, target, 2);
        return {};
    });
}

} // namespace voxtact
