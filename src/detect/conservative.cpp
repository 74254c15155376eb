// SPDX-License-Identifier: MIT
#include "detect/conservative.h"
#include "core/certified_constants.h"
#include "detect/batch.h"
#include "detect/outputs.h"
#include "gpu/scene_impl.h"

#include "voxtact_shaders/certified_comp.h"
#include "voxtact_shaders/certified_outputs_comp.h"

#include <algorithm>

namespace voxtact {

Result<ConservativePass> ConservativePass::create(ContextImpl& context, const DetectorDesc& desc) {
    ConservativePass pass(context, desc);
    const ShaderConstant constants[] = {{VOXTACT_CONSTANT_STOP_AT_FIRST, desc.stopAtFirst ? 1U : 0U},
                                        {VOXTACT_CONSTANT_OUTPUTS, outputsConstant(desc.outputs)}};
    Result<Owned<VkPipeline>> pipeline =
        desc.outputs.any() ? makeComputePipeline(context, spirv::certified_outputs_comp, constants,
                                                 context.computeOutputLayout, "compute conservative outputs")
                           : makeComputePipeline(context, spirv::certified_comp, std::span(constants).first(1),
                                                 context.computeLayout, "compute conservative");
    if (!pipeline.ok()) {
        return pipeline.error();
    }
    pass.pipeline_ = std::move(*pipeline);
    return pass;
}

Result<void> ConservativePass::check(const Batch& batch) const {
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
        if (Result<void> storage = checkStorage(item, "the projection conservative"); !storage.ok()) {
            return storage;
        }
        if (Result<void> groups = checkGroups(*context_, *item.mesh); !groups.ok()) {
            return groups;
        }
    }
    return {};
}

shader::CertifiedConstants ConservativePass::constantsOf(const Batch& batch, const BatchItem& item) const {
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

void ConservativePass::recordItem(VkCommandBuffer commandBuffer, const Batch& batch, const BatchItem& item,
                                  std::uint32_t firstPair, const ResultsImpl& results) const {
    const DeviceFunctions& vk = context_->vk;
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    const VkPipelineLayout layout = bindForCompute(*context_, commandBuffer, item, results, desc_.outputs);
    shader::CertifiedConstants constants = constantsOf(batch, item);
    const auto pairs = static_cast<std::uint32_t>(item.world_from_object.size());
    const std::uint32_t atOnce = context_->limits.maxComputeWorkGroupCount[1];
    for (std::uint32_t done = 0; done < pairs; done += std::min(atOnce, pairs - done)) {
        constants.firstPair = firstPair + done;
        vk.CmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants, &constants);
        vk.CmdDispatch(commandBuffer, groupsOf(*item.mesh), std::min(atOnce, pairs - done), 1);
    }
}

} // namespace voxtact
