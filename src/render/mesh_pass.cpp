// SPDX-License-Identifier: MIT
#include "render/render_impl.h"
#include "vulkan/barriers.h"

#include <algorithm>

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

void bindSets(const RendererImpl& renderer, VkCommandBuffer commandBuffer, VkPipelineLayout layout, std::uint32_t first,
              std::span<const VkDescriptorSet> sets) {
    renderer.context.vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, first,
                                              static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
}

/// Only those that the mesh's shaders read: a scene painted by triangles may have no transfer function to bind.
void bindMeshSets(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const Scene& scene,
                  const MeshPaint& paint, const Target& target) {
    const VkPipelineLayout painted = renderer.paintLayout.get();
    const VkDescriptorSet targets = target.targets->impl().descriptors.set;
    switch (paintedBy(paint.what)) {
    case PaintBy::Nobody:
        bindSets(renderer, commandBuffer, renderer.pictureLayout.get(), PICTURE_SET_TARGETS, {&targets, 1});
        return;
    case PaintBy::Fragments: {
        const VkDescriptorSet sets[] = {scene.volume->impl().descriptors.set,
                                        paint.transferFunction->impl().descriptors.set, targets};
        bindSets(renderer, commandBuffer, painted, VOXTACT_SET_VOLUME, sets);
        return;
    }
    case PaintBy::Triangles: {
        const VkDescriptorSet sets[] = {targets, paint.triangles->impl().descriptors.set};
        bindSets(renderer, commandBuffer, painted, PICTURE_SET_TARGETS, sets);
        return;
    }
    case PaintBy::Vertices: {
        const VkDescriptorSet sets[] = {targets, paint.vertices->impl().descriptors.set};
        bindSets(renderer, commandBuffer, painted, PICTURE_SET_TARGETS, sets);
        return;
    }
    }
}

VkPipelineLayout meshLayout(const RendererImpl& renderer, PaintBy by) {
    return (by == PaintBy::Nobody ? renderer.pictureLayout : renderer.paintLayout).get();
}

/// `which`: index in the buffer of constants.
void drawMesh(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const Scene& scene, const SceneMesh& drawn,
              std::uint32_t which, const Target& target) {
    const PaintBy by = paintedBy(drawn.paint.what);
    bindMeshSets(renderer, commandBuffer, scene, drawn.paint, target);
    const DeviceFunctions& vk = renderer.context.vk;
    const MeshImpl& mesh = drawn.mesh->impl();
    const bool smooth = drawn.normals != nullptr;
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS,
                       renderer.meshPipelines[static_cast<std::size_t>(by)][smooth ? 1 : 0].get());
    vk.CmdPushConstants(commandBuffer, meshLayout(renderer, by), kMeshStages, 0, sizeof which, &which);
    const VkBuffer buffers[] = {mesh.vertices, smooth ? drawn.normals->impl().buffer.get() : VK_NULL_HANDLE};
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

/// Copies constants into the targets' buffer.
void cmdConstants(const RenderTargetsImpl& targets, VkCommandBuffer commandBuffer, VkDeviceSize offset,
                  std::span<const std::byte> data) {
    const ContextImpl& context = targets.renderer.context;
    // Earlier draws still read them.
    barrier(context, commandBuffer, kShaders, 0, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    cmdUpdateBuffer(context, commandBuffer, targets.constants.get(), offset, data);
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, kShaders,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
}

/// Meshes from `first` on: as many as fit. Returns the next.
std::size_t cmdMeshConstants(VkCommandBuffer commandBuffer, const Scene& scene, const Target& target,
                             std::size_t first) {
    std::array<shader::PictureMesh, PICTURE_MESHES> meshes{};
    const std::size_t count = std::min(meshCount(scene) - first, meshes.size());
    for (std::size_t i = 0; i < count; ++i) {
        meshes[i] = setUpMesh(scene, meshOf(scene, first + i));
    }
    if (count > 0) {
        cmdConstants(target.targets->impl(), commandBuffer, sizeof(shader::PictureConstants),
                     std::as_bytes(std::span(meshes).first(count)));
    }
    return first + count;
}

/// Returns the images of the mesh pass: cleared, or kept for the next group of meshes.
void cmdBeginImages(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const RenderTargetsImpl& targets,
                    bool first) {
    const ContextImpl& context = renderer.context;
    ImageUse colour = first ? kColourSampled : kColourWritten;
    ImageUse depth = kDepthUsed;
    if (first) {
        colour.layout = depth.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    }
    ImageUse next = kColourWritten;
    next.access |= VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT;
    for (const Image* image : {&targets.colour, &targets.distance}) {
        barrier(context, commandBuffer, image->image.get(), colour, next);
    }
    barrier(context, commandBuffer, targets.depth.image.get(), depth, kDepthUsed, VK_IMAGE_ASPECT_DEPTH_BIT);
}

void cmdBeginMeshes(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const Scene& scene, bool depthTurned,
                    const Target& target, VkRect2D area, bool first) {
    const RenderTargetsImpl& targets = target.targets->impl();
    cmdBeginImages(renderer, commandBuffer, targets, first);
    const VkAttachmentLoadOp load = first ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    VkRenderingAttachmentInfo colours[] = {renderAttachment(targets.colour.view.get(), kColourWritten.layout, load),
                                           renderAttachment(targets.distance.view.get(), kColourWritten.layout, load)};
    VkRenderingAttachmentInfo depth = renderAttachment(targets.depth.view.get(), kDepthUsed.layout, load);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        colours[0].clearValue.color.float32[channel] = static_cast<float>(scene.background[channel]);
    }
    colours[1].clearValue.color.float32[0] = static_cast<float>(PICTURE_NOTHING);
    depth.clearValue.depthStencil.depth = 1;
    beginRendering(renderer.context, commandBuffer, target.extent, area, colours, &depth, depthTurned);
}

} // namespace

VkRenderingAttachmentInfo renderAttachment(VkImageView view, VkImageLayout layout, VkAttachmentLoadOp load) {
    VkRenderingAttachmentInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    info.imageView = view;
    info.imageLayout = layout;
    info.loadOp = load;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    return info;
}

void beginRendering(const ContextImpl& context, VkCommandBuffer commandBuffer, VkExtent2D extent, VkRect2D area,
                    std::span<const VkRenderingAttachmentInfo> colours, const VkRenderingAttachmentInfo* depth,
                    bool depthTurned) {
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea = area;
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
    context.vk.CmdSetViewport(commandBuffer, 0, 1, &viewport);
    context.vk.CmdSetScissor(commandBuffer, 0, 1, &area);
}

void cmdMeshPass(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const Scene& scene,
                 const PictureSetup& setup, const Target& target, VkRect2D area) {
    const ContextImpl& context = renderer.context;
    cmdConstants(target.targets->impl(), commandBuffer, 0, std::as_bytes(std::span(&setup.constants, 1)));
    const std::size_t meshes = meshCount(scene);
    std::size_t first = 0;
    do {
        const std::size_t next = cmdMeshConstants(commandBuffer, scene, target, first);
        cmdBeginMeshes(renderer, commandBuffer, scene, setup.depthTurned, target, area, first == 0);
        for (std::size_t number = first; number < next; ++number) {
            drawMesh(renderer, commandBuffer, scene, meshOf(scene, number), static_cast<std::uint32_t>(number - first),
                     target);
        }
        context.vk.CmdEndRendering(commandBuffer);
        first = next;
    } while (first < meshes);
    for (const Image* image : {&target.targets->impl().colour, &target.targets->impl().distance}) {
        barrier(context, commandBuffer, image->image.get(), kColourWritten, kColourSampled);
    }
}

} // namespace voxtact
