// SPDX-License-Identifier: MIT
#include "core/guard.h"
#include "core/live.h"
#include "gpu/barriers.h"
#include "gpu/debug.h"
#include "gpu/submit.h"
#include "render/render_impl.h"

namespace voxtact {

namespace {

constexpr ImageUse kColourWritten{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                  VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
constexpr ImageUse kColourSampled{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
constexpr ImageUse kDepthUsed{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
    VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
constexpr VkPipelineStageFlags2 kShaders =
    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;

Error refuse(const char* text) {
    return {ErrorCode::InvalidArgument, 0, text};
}

Result<void> checkMeshParts(const ContextImpl& context, const Scene& scene) {
    if (scene.mesh == nullptr) {
        return scene.normals == nullptr ? Result<void>() : refuse("Scene::normals is given without a mesh");
    }
    if (&scene.mesh->impl().context != &context) {
        return refuse("Scene::mesh belongs to another Context");
    }
    if (scene.normals == nullptr) {
        return {};
    }
    const MeshNormalsImpl& normals = scene.normals->impl();
    const std::optional<MeshFacts> facts = scene.mesh->facts();
    if (&normals.context != &context || (facts && facts->vertices != normals.vertices)) {
        return refuse("Scene::normals is not of Scene::mesh");
    }
    return {};
}

/// Of a scene whose parts belong together.
Result<void> checkAllUploaded(const Scene& scene) {
    const MeshPaint& paint = scene.paint;
    const bool byTriangles = paint.what == Paint::Triangles;
    const bool byFunction = paint.what == Paint::Contacts || paint.what == Paint::Discarded;
    struct Part {
        bool uploaded;
        const char* what;
    };
    for (const Part& part :
         {Part{scene.volume->impl().uploaded, "Scene::volume"},
          Part{scene.transferFunction->impl().uploaded, "Scene::transferFunction"},
          Part{scene.mesh == nullptr || scene.mesh->impl().uploaded, "Scene::mesh"},
          Part{scene.normals == nullptr || scene.normals->impl().uploaded, "Scene::normals"},
          Part{!byTriangles || paint.triangles->impl().uploaded, "Scene::paint.triangles"},
          Part{!byFunction || paint.transferFunction->impl().uploaded, "Scene::paint.transferFunction"}}) {
        if (!part.uploaded) {
            return neverUploaded(part.what);
        }
    }
    if (scene.bricks != nullptr && !scene.volume->impl().bricksFilled) {
        return Error{ErrorCode::NotReady, 0,
                     "Scene::bricks were never filled: record Volume::cmdUpdateBricks() of the whole grid first"};
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
    if (scene.bricks != nullptr && scene.bricks->impl().volume != &scene.volume->impl()) {
        return refuse("Scene::bricks is not of Scene::volume");
    }
    if (Result<void> checked = checkMeshParts(context, scene); !checked.ok()) {
        return checked;
    }
    if (Result<void> checked = checkPaint(context, scene); !checked.ok()) {
        return checked;
    }
    return checkAllUploaded(scene);
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
    return {};
}

VkRenderingAttachmentInfo attachment(VkImageView view, VkImageLayout layout, VkAttachmentLoadOp load) {
    VkRenderingAttachmentInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    info.imageView = view;
    info.imageLayout = layout;
    info.loadOp = load;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    return info;
}

void beginRendering(const ContextImpl& context, VkCommandBuffer commandBuffer, VkExtent2D extent,
                    std::span<const VkRenderingAttachmentInfo> colours, const VkRenderingAttachmentInfo* depth,
                    bool depthTurned) {
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea = {{0, 0}, extent};
    info.layerCount = 1;
    info.colorAttachmentCount = static_cast<std::uint32_t>(colours.size());
    info.pColorAttachments = colours.data();
    info.pDepthAttachment = depth;
    context.vk.CmdBeginRendering(commandBuffer, &info);
    const VkViewport viewport{0,
                              0,
                              static_cast<float>(extent.width),
                              static_cast<float>(extent.height),
                              depthTurned ? 1.0F : 0.0F,
                              depthTurned ? 0.0F : 1.0F};
    const VkRect2D area{{0, 0}, extent};
    context.vk.CmdSetViewport(commandBuffer, 0, 1, &viewport);
    context.vk.CmdSetScissor(commandBuffer, 0, 1, &area);
}

void cmdConstants(const RenderTargetsImpl& targets, VkCommandBuffer commandBuffer,
                  const shader::PictureConstants& constants) {
    const ContextImpl& context = targets.renderer.context;
    // The picture before this one still reads them.
    barrier(context, commandBuffer, kShaders, 0, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    cmdUpdateBuffer(context, commandBuffer, targets.constants.get(), 0, std::as_bytes(std::span(&constants, 1)));
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, kShaders,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
}

void drawMesh(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const Scene& scene, PaintBy paintedBy) {
    const DeviceFunctions& vk = renderer.context.vk;
    const MeshImpl& mesh = scene.mesh->impl();
    const bool smooth = scene.normals != nullptr;
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS,
                       renderer.meshPipelines[static_cast<std::size_t>(paintedBy)][smooth ? 1 : 0].get());
    const VkBuffer buffers[] = {mesh.vertices, smooth ? scene.normals->impl().buffer.get() : VK_NULL_HANDLE};
    const VkDeviceSize offsets[] = {mesh.vertexOffset, 0};
    const VkDeviceSize strides[] = {mesh.vertexStride, 3 * sizeof(float)};
    vk.CmdBindVertexBuffers2(commandBuffer, 0, smooth ? 2 : 1, buffers, offsets, nullptr, strides);
    if (mesh.indices == VK_NULL_HANDLE) {
        vk.CmdDraw(commandBuffer, 3 * mesh.triangleCount, 1, 0, 0);
        return;
    }
    vk.CmdBindIndexBuffer(commandBuffer, mesh.indices, mesh.indexOffset, mesh.indexType);
    vk.CmdDrawIndexed(commandBuffer, 3 * mesh.triangleCount, 1, 0, 0, 0);
}

/// The mesh in front of the background, and its distance; without a mesh the background alone.
void cmdMeshPass(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const Scene& scene,
                 const PictureSetup& setup, const Target& target) {
    const ContextImpl& context = renderer.context;
    const RenderTargetsImpl& targets = target.targets->impl();
    const auto discarded = [](ImageUse use) {
        use.layout = VK_IMAGE_LAYOUT_UNDEFINED;
        return use;
    };
    for (const Image* image : {&targets.colour, &targets.distance}) {
        barrier(context, commandBuffer, image->image.get(), discarded(kColourSampled), kColourWritten);
    }
    barrier(context, commandBuffer, targets.depth.image.get(), discarded(kDepthUsed), kDepthUsed,
            VK_IMAGE_ASPECT_DEPTH_BIT);
    VkRenderingAttachmentInfo colours[] = {
        attachment(targets.colour.view.get(), kColourWritten.layout, VK_ATTACHMENT_LOAD_OP_CLEAR),
        attachment(targets.distance.view.get(), kColourWritten.layout, VK_ATTACHMENT_LOAD_OP_CLEAR)};
    VkRenderingAttachmentInfo depth =
        attachment(targets.depth.view.get(), kDepthUsed.layout, VK_ATTACHMENT_LOAD_OP_CLEAR);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        colours[0].clearValue.color.float32[channel] = static_cast<float>(scene.background[channel]);
    }
    colours[1].clearValue.color.float32[0] = static_cast<float>(PICTURE_NOTHING);
    depth.clearValue.depthStencil.depth = 1;
    beginRendering(context, commandBuffer, target.extent, colours, &depth, setup.depthTurned);
    if (scene.mesh != nullptr) {
        drawMesh(renderer, commandBuffer, scene, setup.paintedBy);
    }
    context.vk.CmdEndRendering(commandBuffer);
    for (const Image* image : {&targets.colour, &targets.distance}) {
        barrier(context, commandBuffer, image->image.get(), kColourWritten, kColourSampled);
    }
}

void cmdVolumePass(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const Target& target) {
    const DeviceFunctions& vk = renderer.context.vk;
    const VkRenderingAttachmentInfo colour = attachment(target.view, target.layout, VK_ATTACHMENT_LOAD_OP_DONT_CARE);
    beginRendering(renderer.context, commandBuffer, target.extent, {&colour, 1}, nullptr, false);
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, renderer.volumePipeline.get());
    vk.CmdDraw(commandBuffer, 3, 1, 0, 0);
    vk.CmdEndRendering(commandBuffer);
}

void bindSets(const RendererImpl& renderer, VkCommandBuffer commandBuffer, VkPipelineLayout layout, std::uint32_t first,
              std::span<const VkDescriptorSet> sets) {
    renderer.context.vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, first,
                                              static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
}

void bindVolumeSets(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const Scene& scene,
                    const Target& target) {
    const VkDescriptorSet sets[] = {scene.volume->impl().descriptors.set, scene.transferFunction->impl().reading.set,
                                    target.targets->impl().descriptors.set,
                                    scene.bricks != nullptr ? scene.bricks->impl().descriptors.set
                                                            : renderer.noBricks.set};
    bindSets(renderer, commandBuffer, renderer.pictureLayout.get(), 0, sets);
}

/// Only those that the mesh's shaders read: a scene that is painted by triangles may have no transfer function to bind.
void bindMeshSets(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const Scene& scene, PaintBy paintedBy,
                  const Target& target) {
    const VkPipelineLayout painted = renderer.paintLayout.get();
    const VkDescriptorSet targets = target.targets->impl().descriptors.set;
    switch (paintedBy) {
    case PaintBy::Nobody:
        bindSets(renderer, commandBuffer, renderer.pictureLayout.get(), PICTURE_SET_TARGETS, {&targets, 1});
        return;
    case PaintBy::Fragments: {
        const VkDescriptorSet sets[] = {scene.volume->impl().descriptors.set,
                                        scene.paint.transferFunction->impl().descriptors.set, targets};
        bindSets(renderer, commandBuffer, painted, VOXTACT_SET_VOLUME, sets);
        return;
    }
    case PaintBy::Triangles: {
        const VkDescriptorSet sets[] = {targets, scene.paint.triangles->impl().descriptors.set};
        bindSets(renderer, commandBuffer, painted, PICTURE_SET_TARGETS, sets);
        return;
    }
    }
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
        if (Result<void> recordable = context.recordable(commandBuffer); !recordable.ok()) {
            return recordable;
        }
        if (Result<void> checked = checkScene(context, scene); !checked.ok()) {
            return checked;
        }
        if (Result<void> checked = checkTarget(context, target); !checked.ok()) {
            return checked;
        }
        const Result<PictureSetup> setup = setUpPicture(scene, target);
        if (!setup.ok()) {
            return setup.error();
        }
        const Label label(context, commandBuffer, "voxtact picture");
        writeTimestamp(context, commandBuffer, target, 0);
        cmdConstants(target.targets->impl(), commandBuffer, setup->constants);
        bindMeshSets(live(impl_), commandBuffer, scene, setup->paintedBy, target);
        cmdMeshPass(live(impl_), commandBuffer, scene, *setup, target);
        writeTimestamp(context, commandBuffer, target, 1);
        bindVolumeSets(live(impl_), commandBuffer, scene, target);
        cmdVolumePass(live(impl_), commandBuffer, target);
        writeTimestamp(context, commandBuffer, target, 2);
        return {};
    });
}

} // namespace voxtact
