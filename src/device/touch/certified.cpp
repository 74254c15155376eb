// SPDX-License-Identifier: MIT
#include "device/touch/certified.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/method/certified_constants.h"
#include "device/detector/batch.h"
#include "device/detector/recording.h"
#include "device/outputs/outputs.h"
#include "device/scene/mesh_layout.h"
#include "device/touch/certified_queues.h"
#include "device/touch/certified_rounds.h"
#include "vulkan/barriers.h"

#include "voxtact_shaders/certified_cull_comp.h"
#include "voxtact_shaders/certified_decide_comp.h"
#include "voxtact_shaders/certified_decide_outputs_comp.h"
#include "voxtact_shaders/certified_expand_comp.h"
#include "voxtact_shaders/certified_finish_comp.h"
#include "voxtact_shaders/certified_finish_outputs_comp.h"
#include "voxtact_shaders/certified_large_comp.h"
#include "voxtact_shaders/certified_refine_comp.h"
#include "voxtact_shaders/certified_tally_comp.h"

namespace voxtact {

namespace {

/// A pass, and the queue that it empties.
struct PassKind {
    std::span<const std::uint32_t> plain;
    std::span<const std::uint32_t> withOutputs;
    const char* name;
    std::uint32_t queue;
};

/// In the order in which they run.
const PassKind kPasses[] = {
    {spirv::certified_cull_comp, spirv::certified_cull_comp, "certified cull", kNoQueue},
    {spirv::certified_refine_comp, spirv::certified_refine_comp, "certified refine", VOXTACT_QUEUE_CLUSTERS},
    {spirv::certified_expand_comp, spirv::certified_expand_comp, "certified expand", VOXTACT_QUEUE_RUNS},
    {spirv::certified_large_comp, spirv::certified_large_comp, "certified large", VOXTACT_QUEUE_LARGE},
    {spirv::certified_decide_comp, spirv::certified_decide_outputs_comp, "certified decide", VOXTACT_QUEUE_CELLS},
    {spirv::certified_finish_comp, spirv::certified_finish_outputs_comp, "certified finish", VOXTACT_QUEUE_OPEN},
};

OpaqueNumbers opaqueOf(const Batch& batch, const BatchItem& item) {
    const VolumeImpl& volume = item.volume->impl();
    const bool whole = volume.storedUnit > 0;
    const double slope = whole ? volume.valueSlope / volume.storedUnit : volume.valueSlope;
    const TransferFunctionImpl& function = item.transferFunction->impl();
    // The entries of a wrapped table are floats: one that is the threshold in single precision reaches it.
    const bool isWrapped = function.texels.get() == VK_NULL_HANDLE;
    const double threshold = isWrapped ? static_cast<double>(static_cast<float>(batch.threshold)) : batch.threshold;
    return opaqueNumbers(function.known.points, threshold, {slope, volume.valueIntercept}, whole);
}

/// Behind what was dispatched before, for what is dispatched next. The passes write to other parts of the buffer.
void recordOpaque(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results,
                  const OpaqueNumbers& opaque) {
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    cmdUpdateBuffer(context, commandBuffer, results.transforms.get(), opaqueByte(results),
                    std::as_bytes(std::span(opaque.numbers)));
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
}

} // namespace

Result<CertifiedPass> CertifiedPass::create(ContextImpl& context, const PassDesc& desc) {
    CertifiedPass pass(context, desc);
    const ShaderConstant constants[] = {{VOXTACT_CONSTANT_STOP_AT_FIRST, desc.stopAtFirst ? 1U : 0U},
                                        {VOXTACT_CONSTANT_COUNTERS, desc.counters ? 1U : 0U},
                                        {VOXTACT_CONSTANT_OUTPUTS, outputsConstant(desc.outputs)}};
    static_assert(std::size(kPasses) == kCertifiedPasses);
    const bool outputs = desc.outputs.any();
    for (std::size_t i = 0; i < kCertifiedPasses; ++i) {
        const PassKind& kind = kPasses[i];
        const Result<VkPipeline> made =
            computePipeline(context, outputs ? kind.withOutputs : kind.plain, constants,
                            outputs ? context.computeOutputLayout : context.computeLayout, kind.name);
        VOXTACT_TRY(made);
        pass.pipelines_[i] = *made;
    }
    if (desc.counters) {
        const Result<VkPipeline> made =
            computePipeline(context, spirv::certified_tally_comp, {},
                            outputs ? context.computeOutputLayout : context.computeLayout, "certified tally");
        VOXTACT_TRY(made);
        pass.tally_ = *made;
    }
    return pass;
}

Result<void> CertifiedPass::check(const Batch& batch) const {
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const BatchItem& item = batch.items[i];
        const std::string which = "batch item " + std::to_string(i) + ": the projection certified needs ";
        if (!item.volume->impl().bricks.buffer) {
            return refuse(which + "a volume with bricks (VolumeOptions::bricks, WrappedVolume::bricks)");
        }
        if (!item.volume->impl().bricksFilled) {
            return Error{ErrorCode::NotReady, 0,
                         "batch item " + std::to_string(i) +
                             ": the bricks of the wrapped volume were never filled: record "
                             "Volume::cmdUpdateBricks() of the whole grid first"};
        }
        if (item.transferFunction->impl().known.points.empty()) {
            return refuse(which + "a transfer function whose table the host knows (WrappedTransferFunction::table)");
        }
        if (const std::size_t numbers = opaqueOf(batch, item).numbers.size(); numbers > VOXTACT_OPAQUE_WORDS) {
            return Error{ErrorCode::LimitExceeded, 0,
                         "batch item " + std::to_string(i) + ": the transfer function has " +
                             std::to_string(item.transferFunction->impl().known.points.size()) +
                             " control points, which make " + std::to_string(numbers) +
                             " numbers; the limit of the projection certified on a device is " +
                             std::to_string(VOXTACT_OPAQUE_WORDS)};
        }
        VOXTACT_TRY(checkStorage(item, "the projection certified"));
    }
    return {};
}

shader::CertifiedConstants CertifiedPass::constantsOf(const BatchItem& item, const OpaqueNumbers& opaque,
                                                      const ResultsImpl& results) const {
    const VolumeImpl& volume = item.volume->impl();
    const MeshImpl& mesh = item.mesh->impl();
    shader::CertifiedConstants constants{};
    constants.item = certifiedItem(volume.grid, opaque, desc_.resolution);
    constants.item.storedUnit = static_cast<float>(volume.storedUnit);
    constants.mesh = meshConstants(mesh);
    constants.triangleCount = mesh.triangleCount;
    constants.clusterWord = mesh.clusterWord.value_or(VOXTACT_NO_CLUSTERS);
    constants.queueWord = firstQueueWord(results);
    constants.queueRoom = results.queueRoom;
    return constants;
}

RoundCut CertifiedPass::cutOf(const BatchItem& item, std::uint32_t queueRoom) const noexcept {
    const MeshLooks looks = meshLooks(item);
    return {looks,
            {.clusters = clustersOf(looks, queueRoom, desc_.stopAtFirst),
             .pairs = context_->limits.maxComputeWorkGroupCount[1],
             .looks = looksOfRound(queueRoom)}};
}

std::uint32_t CertifiedPass::rounds(const Batch& batch, const ResultsImpl& results) const noexcept {
    // Of many pairs it takes longer to count them than to have headers that are not used.
    if (results.pairs > VOXTACT_HEADERS) {
        return VOXTACT_HEADERS;
    }
    std::uint64_t rounds = 0;
    for (const BatchItem& item : batch.items) {
        rounds += roundsOf(cutOf(item, results.queueRoom), VOXTACT_HEADERS);
    }
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(rounds, VOXTACT_HEADERS));
}

void CertifiedPass::record(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results) const {
    RoundRecorder recorder(*context_, commandBuffer, results, tally_);
    const std::vector<RoundPass> passes = passesOfRound();
    std::uint32_t firstPair = 0;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    for (const BatchItem& item : batch.items) {
        layout = bindForCompute(*context_, commandBuffer, item, results, desc_.outputs);
        const OpaqueNumbers opaque = opaqueOf(batch, item);
        recordOpaque(*context_, commandBuffer, results, opaque);
        shader::CertifiedConstants constants = constantsOf(item, opaque, results);
        constants.firstPair = firstPair;
        recorder.record(passes, layout, constants, cutOf(item, results.queueRoom));
        firstPair += static_cast<std::uint32_t>(item.pairs());
    }
    recorder.finish(layout);
}

std::vector<RoundPass> CertifiedPass::passesOfRound() const {
    std::vector<RoundPass> passes;
    for (std::size_t i = 0; i < kCertifiedPasses; ++i) {
        passes.push_back({pipelines_[i], kPasses[i].queue});
    }
    passes.push_back({pipelines_.back(), VOXTACT_QUEUE_LEFT});
    return passes;
}

} // namespace voxtact
