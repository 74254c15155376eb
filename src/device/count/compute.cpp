// SPDX-License-Identifier: MIT
#include "device/count/compute.h"
#include "core/base/try.h"
#include "core/geometry/projection.h"
#include "core/method/method_table.h"
#include "device/count/pixel_slices.h"
#include "device/detector/batch.h"
#include "device/outputs/outputs.h"
#include "device/scene/mesh_layout.h"
#include "exact/exact.h"

#include "voxtact_shaders/compute_comp.h"
#include "voxtact_shaders/compute_outputs_comp.h"

#include <algorithm>

namespace voxtact {

Result<ComputePass> ComputePass::create(ContextImpl& context, const PassDesc& desc) {
    ComputePass pass(context, desc);
    const ShaderConstant constants[] = {
        {VOXTACT_CONSTANT_EXACT_FILTER, desc.filter == Filter::Exact ? 1U : 0U},
        {VOXTACT_CONSTANT_VIEWS, viewsPerPair(desc.projection)},
        {VOXTACT_CONSTANT_DOMINANT_AXIS, rowOf(desc.projection).voxelGrid ? 1U : 0U},
        {VOXTACT_CONSTANT_OUTPUTS, outputsConstant(desc.outputs)},
    };
    const std::string name = std::string("compute ") + toString(desc.projection) + " " + toString(desc.filter);
    const Result<VkPipeline> pipeline =
        desc.outputs.any() ? computePipeline(context, spirv::compute_outputs_comp, constants,
                                             context.computeOutputLayout, (name + " outputs").c_str())
                           : computePipeline(context, spirv::compute_comp, std::span(constants).first(3),
                                             context.computeLayout, name.c_str());
    VOXTACT_TRY(pipeline);
    pass.pipeline_ = *pipeline;
    return pass;
}

Result<void> ComputePass::check(const Batch& batch) const {
    constexpr auto kMost = static_cast<std::uint32_t>(EXACT_GUARD_PIXELS);
    for (const BatchItem& item : batch.items) {
        const VkExtent2D viewport = viewportOf(desc_, batch, item);
        if (viewport.width > kMost || viewport.height > kMost) {
            return Error{ErrorCode::LimitExceeded, 0,
                         "the viewport is " + std::to_string(viewport.width) + "x" + std::to_string(viewport.height) +
                             ", the counting method compute does at most " + std::to_string(kMost) +
                             " pixels per side"};
        }
        VOXTACT_TRY(checkStorage(item, "the counting method compute"));
    }
    return {};
}

shader::ComputeConstants ComputePass::constantsOf(const Batch& batch, const BatchItem& item) const {
    const MeshImpl& mesh = item.mesh->impl();
    shader::ComputeConstants constants{};
    const VkExtent2D viewport = viewportOf(desc_, batch, item);
    constants.item = itemConstants(item, desc_.filter, batch.threshold);
    constants.guardX = shader::exactGuard(viewport.width);
    constants.guardY = shader::exactGuard(viewport.height);
    constants.width = static_cast<int>(viewport.width);
    constants.height = static_cast<int>(viewport.height);
    constants.triangleCount = mesh.triangleCount;
    constants.mesh = meshConstants(mesh);
    constants.grid = dominantGrid(item.volume->grid());
    return constants;
}

void ComputePass::recordItem(VkCommandBuffer commandBuffer, const Batch& batch, const BatchItem& item,
                             Boundary boundary, std::uint32_t firstPair, const ResultsImpl& results) const {
    const DeviceFunctions& vk = context_->vk;
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
    const VkPipelineLayout layout = bindForCompute(*context_, commandBuffer, item, results, desc_.outputs);
    shader::ComputeConstants constants = constantsOf(batch, item);
    constants.rangeTest = boundary == Boundary::Range ? 1 : 0;
    const std::uint32_t viewsOfPair = viewsPerPair(desc_.projection);
    const std::uint32_t views = viewsOfPair * static_cast<std::uint32_t>(item.pairs());
    const std::uint32_t groups = groupsOf(*item.mesh);
    const DrawSize most = drawSize(*context_, viewportOf(desc_, batch, item), item.mesh->triangles());
    const auto& limits = context_->limits.maxComputeWorkGroupCount;
    const std::uint32_t viewsAtOnce = std::min(most.views, limits[1]);
    const std::uint32_t groupsAtOnce = most.triangles == item.mesh->triangles()
                                           ? std::min(groups, limits[0])
                                           : std::clamp(most.triangles / VOXTACT_COMPUTE_GROUP, 1U, limits[0]);
    const PixelSlices slices(*context_, desc_, batch, item, viewportOf(desc_, batch, item));
    for (std::uint32_t group = 0, end = 0; group < groups; group = end) {
        end = slices.endOf(group, group + std::min(groupsAtOnce, groups - group));
        for (std::uint32_t view = 0; view < views; view += std::min(viewsAtOnce, views - view)) {
            constants.firstTransform = viewsOfPair * firstPair + view;
            constants.firstTriangle = group * VOXTACT_COMPUTE_GROUP;
            vk.CmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants, &constants);
            vk.CmdDispatch(commandBuffer, end - group, std::min(viewsAtOnce, views - view), slices.of(group));
        }
    }
}

} // namespace voxtact
