// SPDX-License-Identifier: MIT
#include "device/count/view.h"
#include "core/base/try.h"
#include "core/geometry/projection.h"
#include "core/method/method_table.h"
#include "device/detector/batch.h"
#include "device/outputs/outputs.h"
#include "device/scene/mesh_layout.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"

#include "voxtact_shaders/dominant_vert.h"
#include "voxtact_shaders/view_atomic_frag.h"
#include "voxtact_shaders/view_frag.h"
#include "voxtact_shaders/view_outputs_atomic_frag.h"
#include "voxtact_shaders/view_outputs_frag.h"
#include "voxtact_shaders/view_outputs_subgroup_frag.h"
#include "voxtact_shaders/view_subgroup_frag.h"
#include "voxtact_shaders/view_trace_frag.h"
#include "voxtact_shaders/view_vert.h"

#include <algorithm>

namespace voxtact {

namespace {

std::span<const std::uint32_t> fragmentSpirv(CountingMethod method, bool outputs) {
    const auto either = [outputs](std::span<const std::uint32_t> without, std::span<const std::uint32_t> with) {
        return outputs ? with : without;
    };
    if (rowOf(method).query) {
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
            const ShaderConstant constants[] = {
                {VOXTACT_CONSTANT_RANGE_TEST, rangeTest},
                {VOXTACT_CONSTANT_CARRY, carry},
                {VOXTACT_CONSTANT_EXACT_FILTER, desc_.filter == Filter::Exact ? 1U : 0U},
                {VOXTACT_CONSTANT_OUTPUTS, outputsConstant(desc_.outputs)},
                {VOXTACT_CONSTANT_VIEWS, viewsPerPair(desc_.projection)}};
            const std::string variant = toString(desc_.projection) + (" " + name) + " " + toString(desc_.filter) +
                                        (rangeTest != 0 ? " range" : " clamp") + (carry != 0 ? " carry" : "");
            RasterPipelineDesc desc{.vertexSpirv = spirv::view_vert,
                                    .fragmentSpirv = fragment,
                                    .constants = constants,
                                    .layout = layout,
                                    .overestimate = desc_.overestimate,
                                    .name = variant.c_str()};
            if (dominantAxis()) {
                desc.vertexSpirv = spirv::dominant_vert;
                desc.vertexInput = false;
            }
            Result<Owned<VkPipeline>> pipeline = makeRasterPipeline(*context_, desc);
            VOXTACT_TRY(pipeline);
            pipelines_[rangeTest][carry] = std::move(*pipeline);
        }
    }
    return {};
}

Result<ViewPass> ViewPass::create(ContextImpl& context, const PassDesc& desc) {
    ViewPass pass(context, desc);
    const bool outputs = desc.outputs.any();
    const std::string name = toString(desc.method) + std::string(outputs ? " outputs" : "");
    if (Result<void> made =
            pass.makePipelines(fragmentSpirv(desc.method, outputs), pass.layout(), !rowOf(desc.method).query, name);
        !made.ok()) {
        return made.error();
    }
    return pass;
}

Result<ViewPass> ViewPass::createTrace(ContextImpl& context, Filter filter, VkPipelineLayout layout) {
    // A method that draws an item as one: the list has no use for carries, so both variants are the same.
    ViewPass pass(context, passDesc(RasterDesc{.method = CountingMethod::Atomic, .filter = filter}));
    VOXTACT_TRY(pass.makePipelines(spirv::view_trace_frag, layout, true, "trace"));
    return pass;
}

bool ViewPass::eachAlone() const noexcept {
    return rowOf(desc_.method).query && context_->flushAfterQuery;
}

VkPipelineLayout ViewPass::layout() const noexcept {
    if (desc_.outputs.any()) {
        return context_->rasterOutputLayout;
    }
    return dominantAxis() ? context_->dominantLayout : context_->rasterLayout;
}

VkExtent2D ViewPass::largestViewport(const Batch& batch) const noexcept {
    VkExtent2D largest{0, 0};
    for (const BatchItem& item : batch.items) {
        const VkExtent2D viewport = viewportOf(desc_, batch, item);
        largest = {std::max(largest.width, viewport.width), std::max(largest.height, viewport.height)};
    }
    return largest;
}

void ViewPass::bindPairs(VkCommandBuffer commandBuffer, const ResultsImpl& results) const {
    const VkDescriptorSet set = desc_.outputs.any() ? results.outputs->descriptors.set : results.descriptors.set;
    context_->vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout(), VOXTACT_SET_PAIRS, 1,
                                       &set, 0, nullptr);
}

void ViewPass::bindMesh(VkCommandBuffer commandBuffer, const BatchItem& item) const {
    const DeviceFunctions& vk = context_->vk;
    const MeshImpl& mesh = item.mesh->impl();
    if (dominantAxis()) {
        vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout(), VOXTACT_SET_MESH, 1,
                                 &mesh.descriptors.set, 0, nullptr);
        const shader::DominantConstants constants{dominantGrid(item.volume->grid()), meshConstants(mesh)};
        vk.CmdPushConstants(commandBuffer, layout(), VK_SHADER_STAGE_VERTEX_BIT, VOXTACT_OFFSET_DOMINANT,
                            sizeof constants, &constants);
        return;
    }
    vk.CmdBindVertexBuffers2(commandBuffer, 0, 1, &mesh.vertices, &mesh.vertexOffset, nullptr, &mesh.vertexStride);
    if (mesh.indices != VK_NULL_HANDLE) {
        vk.CmdBindIndexBuffer(commandBuffer, mesh.indices, mesh.indexOffset, mesh.indexType);
    }
}

void ViewPass::beginRendering(VkCommandBuffer commandBuffer, VkExtent2D viewport) const {
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea = {{0, 0}, viewport};
    info.layerCount = 1;
    context_->vk.CmdBeginRendering(commandBuffer, &info);
}

void ViewPass::bindItem(VkCommandBuffer commandBuffer, const Batch& batch, const BatchItem& item, Boundary boundary,
                        const ResultsImpl& results) const {
    const DeviceFunctions& vk = context_->vk;
    const VkExtent2D extent = viewportOf(desc_, batch, item);
    const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    const VkRect2D area{{0, 0}, extent};
    vk.CmdSetViewport(commandBuffer, 0, 1, &viewport);
    vk.CmdSetScissor(commandBuffer, 0, 1, &area);
    const bool carry = !rowOf(desc_.method).query && needsCarry(desc_, batch, item);
    const auto& variants = pipelines_[boundary == Boundary::Range ? 1 : 0];
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, variants[carry ? 1 : 0].get());
    const VkDescriptorSet sets[] = {item.volume->impl().descriptors.set, item.transferFunction->impl().descriptors.set};
    vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout(), VOXTACT_SET_VOLUME, 2, sets, 0,
                             nullptr);
    if (desc_.outputs.any()) {
        const VkDescriptorSet labels = labelSetOf(item, *results.outputs);
        vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout(), VOXTACT_SET_LABELS, 1,
                                 &labels, 0, nullptr);
    }
    const shader::RasterConstants constants{itemConstants(item, desc_.filter, batch.threshold), 0};
    vk.CmdPushConstants(commandBuffer, layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof constants, &constants);
    bindMesh(commandBuffer, item);
}

void ViewPass::recordItem(VkCommandBuffer commandBuffer, const Batch& batch, const BatchItem& item, Boundary boundary,
                          std::uint32_t firstPair, const ResultsImpl& results) const {
    bindItem(commandBuffer, batch, item, boundary, results);
    if (rowOf(desc_.method).query) {
        recordQueries(commandBuffer, viewportOf(desc_, batch, item), item, firstPair, results);
    } else {
        draw(commandBuffer, viewportOf(desc_, batch, item), item, firstPair, static_cast<std::uint32_t>(item.pairs()));
    }
}

void ViewPass::recordQueries(VkCommandBuffer commandBuffer, VkExtent2D viewport, const BatchItem& item,
                             std::uint32_t firstPair, const ResultsImpl& results) const {
    const auto pairs = static_cast<std::uint32_t>(item.pairs());
    for (std::uint32_t pair = firstPair; pair < firstPair + pairs; ++pair) {
        beginQuery(commandBuffer, viewport, results.occlusion.get(), pair);
        draw(commandBuffer, viewport, item, pair, 1);
        endQuery(commandBuffer, results.occlusion.get(), pair);
    }
}

void ViewPass::recordTriangles(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                               std::span<const std::uint32_t> triangles, VkQueryPool queries) const {
    const BatchItem& item = *std::ranges::find_if(batch.items, [](const BatchItem& i) { return i.pairs() > 0; });
    const VkExtent2D viewport = viewportOf(desc_, batch, item);
    bindPairs(commandBuffer, results);
    bindItem(commandBuffer, batch, item, Boundary::Range, results);
    if (!eachAlone()) {
        beginRendering(commandBuffer, viewport);
    }
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        beginQuery(commandBuffer, viewport, queries, i);
        drawPart(commandBuffer, item, triangles[i], 1, 0, 1);
        endQuery(commandBuffer, queries, i);
    }
    if (!eachAlone()) {
        context_->vk.CmdEndRendering(commandBuffer);
    }
}

void ViewPass::beginQuery(VkCommandBuffer commandBuffer, VkExtent2D viewport, VkQueryPool queries,
                          std::uint32_t query) const {
    if (eachAlone()) {
        beginRendering(commandBuffer, viewport);
    }
    const VkQueryControlFlags flags = desc_.method == CountingMethod::Query ? VK_QUERY_CONTROL_PRECISE_BIT : 0;
    context_->vk.CmdBeginQuery(commandBuffer, queries, query, flags);
}

void ViewPass::endQuery(VkCommandBuffer commandBuffer, VkQueryPool queries, std::uint32_t query) const {
    context_->vk.CmdEndQuery(commandBuffer, queries, query);
    if (eachAlone()) {
        context_->vk.CmdEndRendering(commandBuffer);
        barrier(*context_, commandBuffer, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, 0,
                VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT, 0);
    }
}

void ViewPass::draw(VkCommandBuffer commandBuffer, VkExtent2D viewport, const BatchItem& item, std::uint32_t firstPair,
                    std::uint32_t pairs) const {
    const std::uint32_t triangles = item.mesh->triangles();
    const std::uint32_t views = viewsPerPair(desc_.projection);
    const DrawSize most = drawSize(*context_, viewport, triangles);
    for (std::uint32_t view = 0; view < views * pairs; view += std::min(most.views, views * pairs - view)) {
        for (std::uint32_t triangle = 0; triangle < triangles;
             triangle += std::min(most.triangles, triangles - triangle)) {
            if (most.triangles < triangles) {
                context_->vk.CmdPushConstants(commandBuffer, layout(), VK_SHADER_STAGE_FRAGMENT_BIT,
                                              offsetof(shader::RasterConstants, firstTriangle), sizeof triangle,
                                              &triangle);
            }
            drawPart(commandBuffer, item, triangle, std::min(most.triangles, triangles - triangle),
                     views * firstPair + view, std::min(most.views, views * pairs - view));
        }
    }
}

void ViewPass::drawPart(VkCommandBuffer commandBuffer, const BatchItem& item, std::uint32_t firstTriangle,
                        std::uint32_t triangles, std::uint32_t firstView, std::uint32_t views) const {
    if (dominantAxis() || item.mesh->impl().indices == VK_NULL_HANDLE) {
        context_->vk.CmdDraw(commandBuffer, 3 * triangles, views, 3 * firstTriangle, firstView);
    } else {
        context_->vk.CmdDrawIndexed(commandBuffer, 3 * triangles, views, 3 * firstTriangle, 0, firstView);
    }
}

} // namespace voxtact
