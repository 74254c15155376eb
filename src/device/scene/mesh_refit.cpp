// SPDX-License-Identifier: MIT
#include "device/scene/mesh_refit.h"
#include "core/base/try.h"
#include "device/scene/mesh_layout.h"
#include "vulkan/barriers.h"
#include "vulkan/layouts.h"
#include "vulkan/pipeline.h"

#include "voxtact_shaders/mesh_refit_comp.h"

#include <algorithm>
#include <array>

namespace voxtact {

namespace {

constexpr std::uint32_t kBindings = VOXTACT_BINDING_CLUSTERS + 1;

/// Made for the first mesh that needs it, with that of its set.
Result<VkPipelineLayout> refitLayout(ContextImpl& context) {
    const std::lock_guard lock(context.onDemandMutex);
    if (context.refitLayout) {
        return context.refitLayout.get();
    }
    std::array<VkDescriptorSetLayoutBinding, kBindings> bindings{};
    for (std::uint32_t binding = 0; binding < kBindings; ++binding) {
        bindings[binding] = {binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    }
    VOXTACT_TRY(makeSetLayout(context, context.refitSetLayout, bindings, "mesh refit set layout"));
    const VkDescriptorSetLayout set = context.refitSetLayout.get();
    constexpr VkPushConstantRange kConstants{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(shader::RefitConstants)};
    VOXTACT_TRY(
        makePipelineLayout(context, context.refitLayout, {&set, 1}, {&kConstants, 1}, "mesh refit pipeline layout"));
    return context.refitLayout.get();
}

} // namespace

Result<void> makeRefit(MeshImpl& mesh) {
    ContextImpl& context = mesh.context;
    const Result<VkPipelineLayout> layout = refitLayout(context);
    VOXTACT_TRY(layout);
    const Result<VkPipeline> pipeline = computePipeline(context, spirv::mesh_refit_comp, {}, *layout, "mesh refit");
    VOXTACT_TRY(pipeline);
    mesh.refitPipeline = *pipeline;
    const VkDescriptorPoolSize buffers{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kBindings};
    Result<DescriptorSet> set = makeDescriptorSet(context, context.refitSetLayout.get(), {&buffers, 1}, "mesh refit");
    VOXTACT_TRY(set);
    mesh.refitSet = std::move(*set);
    const MeshRanges ranges = rangesOf(mesh);
    writeBuffer(context, mesh.refitSet.set, VOXTACT_BINDING_VERTICES, mesh.vertices, ranges.vertexEnd);
    writeBuffer(context, mesh.refitSet.set, VOXTACT_BINDING_INDICES, mesh.indexed() ? mesh.indices : mesh.vertices,
                ranges.indexEnd);
    writeBuffer(context, mesh.refitSet.set, VOXTACT_BINDING_CLUSTERS, mesh.buffer.get(), mesh.buffer.size);
    return {};
}

void cmdFitClusters(const MeshImpl& mesh, VkCommandBuffer commandBuffer) {
    const ContextImpl& context = mesh.context;
    const DeviceFunctions& vk = context.vk;
    const VkPipelineLayout layout = context.refitLayout.get();
    const shader::RefitConstants constants{sourceConstants(mesh), mesh.triangleCount, *mesh.clusterWord,
                                           mesh.wrapped() && mesh.indexed() ? 1U : 0U};
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, mesh.refitPipeline);
    vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &mesh.refitSet.set, 0,
                             nullptr);
    vk.CmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants, &constants);
    const std::uint32_t clusters = (mesh.triangleCount + kClusterTriangles - 1) / kClusterTriangles;
    const std::uint32_t across = std::min(clusters, context.limits.maxComputeWorkGroupCount[0]);
    vk.CmdDispatch(commandBuffer, across, (clusters + across - 1) / across, 1);
}

void cmdRefitNow(const MeshImpl& mesh, VkCommandBuffer commandBuffer) {
    barrier(mesh.context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    cmdFitClusters(mesh, commandBuffer);
    // What the caller wrote, too: it is drawn from.
    barrier(mesh.context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT);
}

void cmdUploadOrder(const MeshImpl& mesh, VkCommandBuffer commandBuffer) {
    // Earlier readers must be done before the contents go.
    barrier(mesh.context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    const VkBufferCopy order{0, mesh.buffer.size - mesh.staging.size, mesh.staging.size};
    mesh.context.vk.CmdCopyBuffer(commandBuffer, mesh.staging.get(), mesh.buffer.get(), 1, &order);
    cmdRefitNow(mesh, commandBuffer);
}

} // namespace voxtact
