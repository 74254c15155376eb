// SPDX-License-Identifier: MIT
#include "detect/certified.h"
#include "core/base/try.h"
#include "core/method/certified_constants.h"
#include "detect/batch.h"
#include "detect/outputs.h"
#include "detect/recording.h"
#include "gpu/barriers.h"
#include "gpu/scene_impl.h"

#include "voxtact_shaders/certified_again_comp.h"
#include "voxtact_shaders/certified_again_outputs_comp.h"
#include "voxtact_shaders/certified_comp.h"
#include "voxtact_shaders/certified_outputs_comp.h"

#include <algorithm>

namespace voxtact {

namespace {

Result<Owned<VkPipeline>> makePass(ContextImpl& context, const DetectorDesc& desc, std::span<const std::uint32_t> plain,
                                   std::span<const std::uint32_t> withOutputs, const char* name) {
    const ShaderConstant constants[] = {{VOXTACT_CONSTANT_STOP_AT_FIRST, desc.stopAtFirst ? 1U : 0U},
                                        {VOXTACT_CONSTANT_OUTPUTS, outputsConstant(desc.outputs)}};
    return desc.outputs.any()
               ? makeComputePipeline(context, withOutputs, constants, context.computeOutputLayout, name)
               : makeComputePipeline(context, plain, std::span(constants).first(1), context.computeLayout, name);
}

} // namespace

Result<CertifiedPass> CertifiedPass::create(ContextImpl& context, const DetectorDesc& desc) {
    CertifiedPass pass(context, desc);
    Result<Owned<VkPipeline>> first =
        makePass(context, desc, spirv::certified_comp, spirv::certified_outputs_comp, "compute conservative");
    VOXTACT_TRY(first);
    Result<Owned<VkPipeline>> again = makePass(context, desc, spirv::certified_again_comp,
                                               spirv::certified_again_outputs_comp, "compute conservative again");
    VOXTACT_TRY(again);
    pass.first_ = std::move(*first);
    pass.again_ = std::move(*again);
    return pass;
}

Result<void> CertifiedPass::check(const Batch& batch) const {
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const BatchItem& item = batch.items[i];
        const std::string which = "batch item " + std::to_string(i) + ": the projection conservative needs ";
        if (!item.volume->impl().bricks.buffer) {
            return Error{ErrorCode::InvalidArgument, 0,
                         which + "a volume with bricks (VolumeOptions::bricks, WrappedVolume::bricks)"};
        }
        if (!item.volume->impl().bricksFilled) {
            return Error{ErrorCode::NotReady, 0,
                         "batch item " + std::to_string(i) +
                             ": the bricks of the wrapped volume were never filled: record "
                             "Volume::cmdUpdateBricks() of the whole grid first"};
        }
        if (!item.transferFunction->impl().hasExtremes()) {
            return Error{ErrorCode::InvalidArgument, 0,
                         which + "a transfer function whose table the host knows (WrappedTransferFunction::table)"};
        }
        VOXTACT_TRY(checkStorage(item, "the projection conservative"));
        VOXTACT_TRY(checkGroups(*context_, *item.mesh));
    }
    return {};
}

shader::CertifiedConstants CertifiedPass::constantsOf(const Batch& batch, const BatchItem& item) const {
    const VolumeImpl& volume = item.volume->impl();
    const TransferFunctionImpl& function = item.transferFunction->impl();
    const MeshImpl& mesh = item.mesh->impl();
    const double slope = volume.storedUnit > 0 ? volume.valueSlope / volume.storedUnit : volume.valueSlope;
    shader::CertifiedConstants constants{};
    constants.item = certifiedItem(volume.grid, slope, volume.valueIntercept, function.domain, function.table.size(),
                                   batch.threshold, desc_.resolution);
    constants.item.storedUnit = static_cast<float>(volume.storedUnit);
    constants.mesh = meshConstants(mesh);
    constants.triangleCount = mesh.triangleCount;
    constants.clusterCount = mesh.clusterCount;
    constants.clusterWord = mesh.clusterWord;
    return constants;
}

template <class Dispatch>
void CertifiedPass::recordItems(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                                VkPipeline pipeline, const Dispatch& dispatch) const {
    const DeviceFunctions& vk = context_->vk;
    const std::uint32_t atOnce = context_->limits.maxComputeWorkGroupCount[1];
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    std::uint32_t firstPair = 0;
    for (const BatchItem& item : batch.items) {
        const auto pairs = static_cast<std::uint32_t>(item.world_from_object.size());
        const VkPipelineLayout layout = bindForCompute(*context_, commandBuffer, item, results, desc_.outputs);
        shader::CertifiedConstants constants = constantsOf(batch, item);
        constants.firstOpen = firstOpen(results.pairs);
        for (std::uint32_t done = 0; done < pairs; done += std::min(atOnce, pairs - done)) {
            constants.firstPair = firstPair + done;
            vk.CmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants, &constants);
            dispatch(item, constants.firstPair, std::min(atOnce, pairs - done));
        }
        firstPair += pairs;
    }
}

void CertifiedPass::recordFirst(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results) const {
    recordItems(commandBuffer, batch, results, first_.get(),
                [&](const BatchItem& item, std::uint32_t /*firstPair*/, std::uint32_t pairs) {
                    context_->vk.CmdDispatch(commandBuffer, groupsOf(*item.mesh), pairs, 1);
                });
}

void CertifiedPass::recordAgain(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results) const {
    barrier(*context_, commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
    recordItems(commandBuffer, batch, results, again_.get(),
                [&](const BatchItem& /*item*/, std::uint32_t firstPair, std::uint32_t /*pairs*/) {
                    const VkDeviceSize at = VkDeviceSize{firstOpen(results.pairs)} + firstPair;
                    context_->vk.CmdDispatchIndirect(commandBuffer, results.transforms.get(),
                                                     at * sizeof(shader::CertifiedOpen) +
                                                         offsetof(shader::CertifiedOpen, groupsX));
                });
}

} // namespace voxtact
