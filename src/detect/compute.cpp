// SPDX-License-Identifier: MIT
#include "detect/compute.h"
#include "detect/batch.h"
#include "detect/outputs.h"
#include "exact.h"
#include "gpu/scene_impl.h"

#include "voxtact_shaders/compute_comp.h"
#include "voxtact_shaders/compute_outputs_comp.h"

#include <algorithm>

namespace voxtact {

namespace {

std::uint32_t groupsOf(const Mesh& mesh) {
    return (mesh.triangles() + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP;
}

std::uint32_t indexBytes(const MeshImpl& mesh) {
    if (mesh.indices == VK_NULL_HANDLE) {
        return 0;
    }
    return mesh.indexType == VK_INDEX_TYPE_UINT16 ? 2 : 4;
}

} // namespace

Result<ComputePass> ComputePass::create(ContextImpl& context, Filter filter, const Outputs& outputs) {
    ComputePass pass(context, filter, outputs.any());
    const ShaderConstant constants[] = {{VOXTACT_CONSTANT_EXACT_FILTER, filter == Filter::Exact ? 1U : 0U},
                                        {VOXTACT_CONSTANT_OUTPUTS, outputsConstant(outputs)}};
    const std::string name = std::string("compute ") + toString(filter);
    Result<Owned<VkPipeline>> pipeline =
        outputs.any() ? makeComputePipeline(context, spirv::compute_outputs_comp, constants,
                                            context.computeOutputLayout, (name + " outputs").c_str())
                      : makeComputePipeline(context, spirv::compute_comp, std::span(constants).first(1),
                                            context.computeLayout, name.c_str());
    if (!pipeline.ok()) {
        return pipeline.error();
    }
    pass.pipeline_ = std::move(*pipeline);
    return pass;
}

Result<void> ComputePass::check(const Batch& batch) const {
    constexpr auto kMost = static_cast<std::uint32_t>(EXACT_GUARD_PIXELS);
    if (batch.view.width > kMost || batch.view.height > kMost) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the viewport is " + std::to_string(batch.view.width) + "x" + std::to_string(batch.view.height) +
                         ", the counting method compute does at most " + std::to_string(kMost) + " pixels a side"};
    }
    for (const BatchItem& item : batch.items) {
        if (const std::string& reason = item.mesh->impl().noCompute; !reason.empty()) {
            return Error{ErrorCode::Unsupported, 0, "the counting method compute cannot be used: " + reason};
        }
        if (groupsOf(*item.mesh) > context_->limits.maxComputeWorkGroupCount[0]) {
            return Error{ErrorCode::LimitExceeded, 0,
                         "the mesh has " + std::to_string(item.mesh->triangles()) +
                             " triangles, the device's maxComputeWorkGroupCount allows for " +
                             std::to_string(std::uint64_t{context_->limits.maxComputeWorkGroupCount[0]} *
                                            VOXTACT_COMPUTE_GROUP)};
        }
    }
    return {};
}

shader::ComputeConstants ComputePass::constantsOf(const Batch& batch, const BatchItem& item) const {
    const MeshImpl& mesh = item.mesh->impl();
    shader::ComputeConstants constants{};
    constants.item = itemConstants(item, filter_, batch.threshold);
    constants.guardX = shader::exactGuard(batch.view.width);
    constants.guardY = shader::exactGuard(batch.view.height);
    constants.width = static_cast<int>(batch.view.width);
    constants.height = static_cast<int>(batch.view.height);
    constants.triangleCount = mesh.triangleCount;
    constants.vertexOffset = static_cast<std::uint32_t>(mesh.vertexOffset / sizeof(float));
    constants.vertexStride = static_cast<std::uint32_t>(mesh.vertexStride / sizeof(float));
    constants.indexOffset = static_cast<std::uint32_t>(mesh.indexOffset);
    constants.indexBytes = indexBytes(mesh);
    return constants;
}

void ComputePass::recordItem(VkCommandBuffer commandBuffer, const Batch& batch, const BatchItem& item,
                             Boundary boundary, std::uint32_t firstPair, const ResultsImpl& results) const {
    const DeviceFunctions& vk = context_->vk;
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    const VkPipelineLayout layout = outputs_ ? context_->computeOutputLayout : context_->computeLayout;
    const VkDescriptorSet sets[] = {item.volume->impl().descriptors.set, item.transferFunction->impl().descriptors.set,
                                    outputs_ ? results.outputs->descriptors.set : results.descriptors.set,
                                    item.mesh->impl().descriptors.set,
                                    outputs_ ? labelSetOf(item, *results.outputs) : VK_NULL_HANDLE};
    vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, outputs_ ? 5 : 4, sets, 0,
                             nullptr);
    shader::ComputeConstants constants = constantsOf(batch, item);
    constants.rangeTest = boundary == Boundary::Range ? 1 : 0;
    const auto pairs = static_cast<std::uint32_t>(item.world_from_object.size());
    const std::uint32_t atOnce = context_->limits.maxComputeWorkGroupCount[1];
    for (std::uint32_t done = 0; done < pairs; done += std::min(atOnce, pairs - done)) {
        constants.firstPair = firstPair + done;
        vk.CmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants, &constants);
        vk.CmdDispatch(commandBuffer, groupsOf(*item.mesh), std::min(atOnce, pairs - done), 1);
    }
}

} // namespace voxtact
