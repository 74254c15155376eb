// SPDX-License-Identifier: MIT
#include "detect/view.h"
#include "detect/batch.h"
#include "detect/counting.h"
#include "detect/outputs.h"
#include "gpu/barriers.h"
#include "gpu/debug.h"
#include "gpu/scene_impl.h"

#include "voxtact_shaders/view_atomic_frag.h"
#include "voxtact_shaders/view_frag.h"
#include "voxtact_shaders/view_outputs_atomic_frag.h"
#include "voxtact_shaders/view_outputs_frag.h"
#include "voxtact_shaders/view_outputs_subgroup_frag.h"
#include "voxtact_shaders/view_subgroup_frag.h"
#include "voxtact_shaders/view_trace_frag.h"
#include "voxtact_shaders/view_vert.h"

namespace voxtact {

namespace {

std::span<const std::uint32_t> fragmentSpirv(CountingMethod method, bool outputs) {
    const auto either = [outputs](std::span<const std::uint32_t> without, std::span<const std::uint32_t> with) {
        return outputs ? with : without;
    };
    if (countsByQuery(method)) {
        return either(spirv::view_frag, spirv::view_outputs_frag);
    }
    if (method == CountingMethod::Subgroup) {
        return either(spirv::view_subgroup_frag, spirv::view_outputs_subgroup_frag);
    }
    return either(spirv::view_atomic_frag, spirv::view_outputs_atomic_frag);
}

} // namespace

Result<void> ViewPass::makePipelines(std::span<const std::uint32_t> fragment, VkPipelineLayout layout, bool withCarry,
                                     const std::string& name) {
    for (std::uint32_t rangeTest = 0; rangeTest < 2; ++rangeTest) {
        for (std::uint32_t carry = 0; carry < (withCarry ? 2U : 1U); ++carry) {
            const ShaderConstant constants[] = {{VOXTACT_CONSTANT_RANGE_TEST, rangeTest},
                                                {VOXTACT_CONSTANT_CARRY, carry},
                                                {VOXTACT_CONSTANT_EXACT_FILTER, filter_ == Filter::Exact ? 1U : 0U},
                                                {VOXTACT_CONSTANT_OUTPUTS, outputsConstant(outputs_)}};
            const std::string variant = "view " + name + " " + toString(filter_) +
                                        (rangeTest != 0 ? " range" : " clamp") + (carry != 0 ? " carry" : "");
            Result<Owned<VkPipeline>> pipeline =
                makeRasterPipeline(*context_, {spirv::view_vert, fragment, constants, layout, variant.c_str()});
            if (!pipeline.ok()) {
                return pipeline.error();
            }
            pipelines_[rangeTest][carry] = std::move(*pipeline);
        }
    }
    return {};
}

Result<ViewPass> ViewPass::create(ContextImpl& context, CountingMethod method, Filter filter, const Outputs& outputs) {
    ViewPass pass(context, method, filter);
    pass.outputs_ = outputs;
    const std::string name = toString(method) + std::string(outputs.any() ? " outputs" : "");
    if (Result<void> made =
            pass.makePipelines(fragmentSpirv(method, outputs.any()), pass.layout(), !countsByQuery(method), name);
        !made.ok()) {
        return made.error();
    }
    return pass;
}

Result<ViewPass> ViewPass::createTrace(ContextImpl& context, Filter filter, VkPipelineLayout layout) {
    // A method that draws an item as one: the list has no use for carries, so both variants are the same.
    ViewPass pass(context, CountingMethod::Atomic, filter);
    if (Result<void> made = pass.makePipelines(spirv::view_trace_frag, layout, true, "trace"); !made.ok()) {
        return made.error();
    }
    return pass;
}

VkPipelineLayout ViewPass::layout() const noexcept {
    return outputs_.any() ? context_->rasterOutputLayout : context_->rasterLayout;
}

bool ViewPass::eachAlone() const noexcept {
    return countsByQuery(method_) && context_->flushAfterQuery;
}

void ViewPass::bindBatch(VkCommandBuffer commandBuffer, const View& view, const ResultsImpl& results) const {
    const DeviceFunctions& vk = context_->vk;
    const VkViewport viewport{0, 0, static_cast<float>(view.width), static_cast<float>(view.height), 0, 1};
    const VkRect2D area{{0, 0}, {view.width, view.height}};
    vk.CmdSetViewport(commandBuffer, 0, 1, &viewport);
    vk.CmdSetScissor(commandBuffer, 0, 1, &area);
    const VkDescriptorSet set = outputs_.any() ? results.outputs->descriptors.set : results.descriptors.set;
    vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout(), VOXTACT_SET_PAIRS, 1, &set, 0,
                             nullptr);
}

void ViewPass::beginRendering(VkCommandBuffer commandBuffer, const View& view) const {
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea = {{0, 0}, {view.width, view.height}};
    info.layerCount = 1;
    context_->vk.CmdBeginRendering(commandBuffer, &info);
}

void ViewPass::recordItem(VkCommandBuffer commandBuffer, const Batch& batch, const BatchItem& item, Boundary boundary,
                          std::uint32_t firstPair, const ResultsImpl& results) const {
    const DeviceFunctions& vk = context_->vk;
    const bool carry = !countsByQuery(method_) && needsCarry(batch, item);
    const auto& variants = pipelines_[boundary == Boundary::Range ? 1 : 0];
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, variants[carry ? 1 : 0].get());
    const VkDescriptorSet sets[] = {item.volume->impl().descriptors.set, item.transferFunction->impl().descriptors.set};
    vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout(), VOXTACT_SET_VOLUME, 2, sets, 0,
                             nullptr);
    if (outputs_.any()) {
        const VkDescriptorSet labels = labelSetOf(item, *results.outputs);
        vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout(), VOXTACT_SET_LABELS, 1,
                                 &labels, 0, nullptr);
    }
    const shader::ItemConstants constants = itemConstants(item, filter_, batch.threshold);
    vk.CmdPushConstants(commandBuffer, layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof constants, &constants);
    const MeshImpl& mesh = item.mesh->impl();
    vk.CmdBindVertexBuffers2(commandBuffer, 0, 1, &mesh.vertices, &mesh.vertexOffset, nullptr, &mesh.vertexStride);
    if (mesh.indices != VK_NULL_HANDLE) {
        vk.CmdBindIndexBuffer(commandBuffer, mesh.indices, mesh.indexOffset, mesh.indexType);
    }
    if (countsByQuery(method_)) {
        recordQueries(commandBuffer, batch.view, item, firstPair, results);
    } else {
        draw(commandBuffer, item, firstPair, static_cast<std::uint32_t>(item.world_from_object.size()));
    }
}

void ViewPass::recordQueries(VkCommandBuffer commandBuffer, const View& view, const BatchItem& item,
                             std::uint32_t firstPair, const ResultsImpl& results) const {
    const DeviceFunctions& vk = context_->vk;
    const auto pairs = static_cast<std::uint32_t>(item.world_from_object.size());
    const VkQueryControlFlags flags = method_ == CountingMethod::Query ? VK_QUERY_CONTROL_PRECISE_BIT : 0;
    for (std::uint32_t pair = firstPair; pair < firstPair + pairs; ++pair) {
        if (eachAlone()) {
            beginRendering(commandBuffer, view);
        }
        vk.CmdBeginQuery(commandBuffer, results.occlusion.get(), pair, flags);
        draw(commandBuffer, item, pair, 1);
        vk.CmdEndQuery(commandBuffer, results.occlusion.get(), pair);
        if (eachAlone()) {
            vk.CmdEndRendering(commandBuffer);
            barrier(*context_, commandBuffer, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, 0,
                    VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT, 0);
        }
    }
}

void ViewPass::draw(VkCommandBuffer commandBuffer, const BatchItem& item, std::uint32_t firstPair,
                    std::uint32_t pairs) const {
    const MeshImpl& mesh = item.mesh->impl();
    if (mesh.indices == VK_NULL_HANDLE) {
        context_->vk.CmdDraw(commandBuffer, 3 * mesh.triangleCount, pairs, 0, firstPair);
    } else {
        context_->vk.CmdDrawIndexed(commandBuffer, 3 * mesh.triangleCount, pairs, 0, 0, firstPair);
    }
}

} // namespace voxtact
