// SPDX-License-Identifier: MIT
#include "detect/certified/certified.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/method/certified_constants.h"
#include "detect/batch.h"
#include "detect/certified/certified_queues.h"
#include "detect/certified/certified_rounds.h"
#include "detect/outputs/outputs.h"
#include "detect/recording.h"
#include "gpu/mesh_layout.h"

#include "voxtact_shaders/certified_cull_comp.h"
#include "voxtact_shaders/certified_cull_touches_comp.h"
#include "voxtact_shaders/certified_decide_comp.h"
#include "voxtact_shaders/certified_decide_outputs_comp.h"
#include "voxtact_shaders/certified_decide_touches_comp.h"
#include "voxtact_shaders/certified_expand_comp.h"
#include "voxtact_shaders/certified_finish_comp.h"
#include "voxtact_shaders/certified_finish_outputs_comp.h"
#include "voxtact_shaders/certified_finish_touches_comp.h"
#include "voxtact_shaders/certified_large_comp.h"
#include "voxtact_shaders/certified_margin_cull_comp.h"
#include "voxtact_shaders/certified_margin_decide_comp.h"
#include "voxtact_shaders/certified_margin_expand_comp.h"
#include "voxtact_shaders/certified_margin_finish_comp.h"
#include "voxtact_shaders/certified_margin_large_comp.h"
#include "voxtact_shaders/certified_margin_refine_comp.h"
#include "voxtact_shaders/certified_refine_comp.h"
#include "voxtact_shaders/certified_refine_touches_comp.h"
#include "voxtact_shaders/certified_tally_comp.h"

namespace voxtact {

namespace {

/// A pass, and the queue that it empties.
struct PassKind {
    std::span<const std::uint32_t> plain;
    std::span<const std::uint32_t> withOutputs;
    std::span<const std::uint32_t> withMargin;
    std::span<const std::uint32_t> withTouches; ///< that say where a pair touches
    const char* name;
    std::uint32_t queue;
};

/// In the order in which they run.
const PassKind kPasses[] = {
    {spirv::certified_cull_comp, spirv::certified_cull_comp, spirv::certified_margin_cull_comp,
     spirv::certified_cull_touches_comp, "conservative cull", kNoQueue},
    {spirv::certified_refine_comp, spirv::certified_refine_comp, spirv::certified_margin_refine_comp,
     spirv::certified_refine_touches_comp, "conservative refine", VOXTACT_QUEUE_CLUSTERS},
    {spirv::certified_expand_comp, spirv::certified_expand_comp, spirv::certified_margin_expand_comp,
     spirv::certified_expand_comp, "conservative expand", VOXTACT_QUEUE_RUNS},
    {spirv::certified_large_comp, spirv::certified_large_comp, spirv::certified_margin_large_comp,
     spirv::certified_large_comp, "conservative large", VOXTACT_QUEUE_LARGE},
    {spirv::certified_decide_comp, spirv::certified_decide_outputs_comp, spirv::certified_margin_decide_comp,
     spirv::certified_decide_touches_comp, "conservative decide", VOXTACT_QUEUE_CELLS},
    {spirv::certified_finish_comp, spirv::certified_finish_outputs_comp, spirv::certified_margin_finish_comp,
     spirv::certified_finish_touches_comp, "conservative finish", VOXTACT_QUEUE_OPEN},
};

/// Whether where a pair touches is wanted.
bool keepsTouch(const DetectorDesc& desc) {
    return desc.closest || desc.motion;
}

std::span<const std::uint32_t> programOf(const PassKind& kind, const DetectorDesc& desc) {
    return desc.margin > 0      ? kind.withMargin
           : desc.outputs.any() ? kind.withOutputs
           : keepsTouch(desc)   ? kind.withTouches
                                : kind.plain;
}

} // namespace

Result<CertifiedPass> CertifiedPass::create(ContextImpl& context, const DetectorDesc& desc) {
    CertifiedPass pass(context, desc);
    const ShaderConstant constants[] = {
        {VOXTACT_CONSTANT_STOP_AT_FIRST, desc.stopAtFirst ? 1U : 0U},
        {VOXTACT_CONSTANT_COUNTERS, desc.counters ? 1U : 0U},
        {VOXTACT_CONSTANT_LISTED, desc.motion ? 1U : 0U},
        {VOXTACT_CONSTANT_OUTPUTS, keepsTouch(desc) ? VOXTACT_OUTPUT_TOUCH : outputsConstant(desc.outputs)}};
    static_assert(std::size(kPasses) == kCertifiedPasses);
    const bool outputs = desc.outputs.any();
    for (std::size_t i = 0; i < kCertifiedPasses; ++i) {
        const PassKind& kind = kPasses[i];
        const Result<VkPipeline> made =
            computePipeline(context, programOf(kind, desc), constants,
                            outputs ? context.computeOutputLayout : context.computeLayout, kind.name);
        VOXTACT_TRY(made);
        pass.pipelines_[i] = *made;
    }
    if (desc.counters) {
        const Result<VkPipeline> made =
            computePipeline(context, spirv::certified_tally_comp, {},
                            outputs ? context.computeOutputLayout : context.computeLayout, "conservative tally");
        VOXTACT_TRY(made);
        pass.tally_ = *made;
    }
    if (desc.poseTolerance && (desc.poseTolerance->angle > 0 || desc.poseTolerance->distance > 0)) {
        Result<TolerancePass> made = TolerancePass::create(context, desc);
        VOXTACT_TRY(made);
        pass.tolerance_ = *made;
    }
    if (desc.clearance) {
        Result<ClearancePass> made = ClearancePass::create(context, desc);
        VOXTACT_TRY(made);
        pass.clearance_ = *made;
    }
    if (desc.motion) {
        Result<MotionPass> made = MotionPass::create(context, desc);
        VOXTACT_TRY(made);
        pass.motion_ = *made;
    }
    return pass;
}

Result<void> CertifiedPass::check(const Batch& batch) const {
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const BatchItem& item = batch.items[i];
        const std::string which = "batch item " + std::to_string(i) + ": the projection conservative needs ";
        if (!item.volume->impl().bricks.buffer) {
            return refuse(which + "a volume with bricks (VolumeOptions::bricks, WrappedVolume::bricks)");
        }
        if (!item.volume->impl().bricksFilled) {
            return Error{ErrorCode::NotReady, 0,
                         "batch item " + std::to_string(i) +
                             ": the bricks of the wrapped volume were never filled: record "
                             "Volume::cmdUpdateBricks() of the whole grid first"};
        }
        if (!item.transferFunction->impl().hasExtremes()) {
            return refuse(which + "a transfer function whose table the host knows (WrappedTransferFunction::table)");
        }
        VOXTACT_TRY(checkStorage(item, "the projection conservative"));
    }
    return {};
}

shader::CertifiedConstants CertifiedPass::constantsOf(const Batch& batch, const BatchItem& item,
                                                      const ResultsImpl& results) const {
    const VolumeImpl& volume = item.volume->impl();
    const TransferFunctionImpl& function = item.transferFunction->impl();
    const MeshImpl& mesh = item.mesh->impl();
    const double slope = volume.storedUnit > 0 ? volume.valueSlope / volume.storedUnit : volume.valueSlope;
    shader::CertifiedConstants constants{};
    constants.item = certifiedItem(volume.grid, slope, volume.valueIntercept, function.domain, function.table.size(),
                                   batch.threshold, desc_.resolution);
    if (desc_.margin > 0) {
        constants.item = withMargin(constants.item, volume.grid, desc_.margin);
    }
    constants.item.storedUnit = static_cast<float>(volume.storedUnit);
    constants.mesh = meshConstants(mesh);
    constants.triangleCount = mesh.triangleCount;
    constants.clusterWord = mesh.clusterWord.value_or(VOXTACT_NO_CLUSTERS);
    constants.queueWord = firstQueueWord(results);
    constants.queueRoom = results.queueRoom;
    return constants;
}

RoundCut CertifiedPass::cutOf(const BatchItem& item, std::uint32_t queueRoom) const noexcept {
    const MeshLooks looks = meshLooks(item, desc_.margin);
    return {looks,
            {.clusters = clustersOf(looks, queueRoom, desc_.stopAtFirst && !(desc_.margin > 0)),
             .pairs = context_->limits.maxComputeWorkGroupCount[1],
             .looks = looksOfRound(queueRoom)}};
}

std::uint32_t CertifiedPass::rounds(const Batch& batch, const ResultsImpl& results) const noexcept {
    // Of many pairs it takes longer to count them than to have headers that are not used.
    if (tolerance_ || clearance_ || motion_ || results.pairs > VOXTACT_HEADERS) {
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
        shader::CertifiedConstants constants = constantsOf(batch, item, results);
        constants.firstPair = firstPair;
        const RoundCut cut = cutOf(item, results.queueRoom);
        if (motion_) {
            motion_->record(recorder, layout, item, constants, {passes, cut});
        } else {
            recorder.record(passes, layout, constants, cut);
        }
        if (tolerance_) {
            tolerance_->record(recorder, layout, item, constants);
        }
        if (clearance_) {
            clearance_->record(recorder, layout, item, constants, batch.labels);
        }
        firstPair += static_cast<std::uint32_t>(item.pairs());
    }
    recorder.finish(layout);
}

std::vector<RoundPass> CertifiedPass::passesOfRound() const {
    std::vector<RoundPass> passes;
    for (std::size_t i = 0; i < kCertifiedPasses; ++i) {
        if (desc_.margin > 0 && kPasses[i].queue == VOXTACT_QUEUE_OPEN) {
            continue; // no cell is left open
        }
        passes.push_back({pipelines_[i], kPasses[i].queue});
    }
    passes.push_back({pipelines_.back(), VOXTACT_QUEUE_LEFT});
    return passes;
}

} // namespace voxtact
