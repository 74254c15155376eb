// SPDX-License-Identifier: MIT
#include "device/outputs/outputs.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/batch/output_pair.h"
#include "core/method/method_table.h"
#include "device/scene/scene_impl.h"
#include "vulkan/submit.h"

namespace voxtact {

namespace {

Error unsupported(const std::string& reason) {
    return {ErrorCode::Unsupported, 0, "the outputs in addition to the counts cannot be had on this device: " + reason};
}

Result<void> checkLabelMaps(const ContextImpl& context, const Batch& batch, const Outputs& outputs) {
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const LabelMap* labels = batch.items[i].labels;
        if (labels == nullptr && outputs.labels) {
            return refuse("batch item " + std::to_string(i) + " has no label map, which the output labels needs");
        }
        if (labels != nullptr) {
            VOXTACT_TRY(checkLabelMap(context, *labels, "batch item " + std::to_string(i)));
        }
    }
    return {};
}

Result<void> checkRoom(const char* what, std::uint64_t needed, std::uint64_t room) {
    if (needed > room) {
        return refuse("the pairs of the batch have " + std::to_string(needed) + " " + what +
                      ", the Results have room for " + std::to_string(room));
    }
    return {};
}

} // namespace

VkPipelineLayout bindForCompute(const ContextImpl& context, VkCommandBuffer commandBuffer, const BatchItem& item,
                                const ResultsImpl& results, const Outputs& outputs) {
    const bool any = outputs.any();
    const VkPipelineLayout layout = any ? context.computeOutputLayout : context.computeLayout;
    const VkDescriptorSet sets[] = {item.volume->impl().descriptors.set, item.transferFunction->impl().descriptors.set,
                                    any ? results.outputs->descriptors.set : results.descriptors.set,
                                    item.mesh->impl().descriptors.set,
                                    any ? labelSetOf(item, *results.outputs) : VK_NULL_HANDLE};
    context.vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, any ? 5 : 4, sets, 0,
                                     nullptr);
    return layout;
}

Result<void> checkLabelMap(const ContextImpl& context, const LabelMap& labels, const std::string& which) {
    if (&labels.impl().context != &context) {
        return refuse(which + ": the label map belongs to another Context");
    }
    return labels.impl().uploaded ? Result<void>() : neverUploaded(which + ": the label map");
}

Result<void> checkOutputs(const ContextImpl& context, const PassDesc& desc) {
    if (!desc.outputs.any()) {
        return {};
    }
    VOXTACT_TRY(checkOutputs(desc.outputs, desc.stopAtFirst));
    const bool rasterised = rowOf(desc.method).coverage == Coverage::Rasteriser;
    if (rasterised && !context.features.fragmentStoresAndAtomics) {
        return unsupported("fragmentStoresAndAtomics is not enabled");
    }
    if (rasterised && !context.features.geometryShader) {
        return unsupported("geometryShader is not enabled (gl_PrimitiveID needs it)");
    }
    if (context.limits.maxBoundDescriptorSets < kOutputSets) {
        return unsupported("maxBoundDescriptorSets is " + std::to_string(context.limits.maxBoundDescriptorSets) + ", " +
                           std::to_string(kOutputSets) + " are needed");
    }
    if (context.limits.maxPerStageDescriptorStorageBuffers < kOutputStorageBuffers) {
        return unsupported("maxPerStageDescriptorStorageBuffers is " +
                           std::to_string(context.limits.maxPerStageDescriptorStorageBuffers) + ", " +
                           std::to_string(kOutputStorageBuffers) + " are needed");
    }
    return {};
}

Result<void> checkOutputs(const ContextImpl& context, const Batch& batch, const Outputs& outputs,
                          const ResultsImpl& results) {
    if (!outputs.any()) {
        return {};
    }
    VOXTACT_TRY(checkLabelMaps(context, batch, outputs));
    if ((outputsConstant(outputs) & ~results.outputBits) != 0) {
        return refuse("the detector has outputs that the detector of the Results lacks");
    }
    const OutputRoom needed = roomFor(batch, outputs);
    VOXTACT_TRY(checkRoom("triangles", needed.triangles, results.outputs->room.triangles));
    return checkRoom("labels", needed.labels, results.outputs->room.labels);
}

} // namespace voxtact
