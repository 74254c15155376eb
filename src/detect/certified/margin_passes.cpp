// SPDX-License-Identifier: MIT
#include "detect/certified/margin_passes.h"
#include "core/base/try.h"
#include "detect/certified/certified_rounds.h"

#include <string>

namespace voxtact {

namespace {

struct MarginPass {
    const char* name;
    std::uint32_t queue; ///< that it empties
};
constexpr std::array<MarginPass, MarginPasses::kCount> kMarginPasses{{{" cull", kNoQueue},
                                                                      {" refine", VOXTACT_QUEUE_CLUSTERS},
                                                                      {" expand", VOXTACT_QUEUE_RUNS},
                                                                      {" large", VOXTACT_QUEUE_LARGE},
                                                                      {" decide", VOXTACT_QUEUE_CELLS},
                                                                      {" finish", VOXTACT_QUEUE_LEFT}}};

} // namespace

Result<MarginPasses> MarginPasses::create(ContextImpl& context, const Programs& programs,
                                          std::span<const ShaderConstant> constants, const char* name) {
    MarginPasses passes(context);
    for (std::size_t i = 0; i < kCount; ++i) {
        const Result<VkPipeline> made = computePipeline(context, programs[i], constants, context.computeLayout,
                                                        (std::string(name) + kMarginPasses[i].name).c_str());
        VOXTACT_TRY(made);
        passes.pipelines_[i] = *made;
    }
    return passes;
}

void MarginPasses::record(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                          const shader::CertifiedConstants& given, double reach) const {
    std::array<RoundPass, kCount> passes{};
    for (std::size_t i = 0; i < kCount; ++i) {
        passes[i] = {pipelines_[i], kMarginPasses[i].queue};
    }
    const RoundLimits limits{.clusters = clustersOfRound(given.queueRoom, false),
                             .pairs = context_->limits.maxComputeWorkGroupCount[1],
                             .looks = looksOfRound(given.queueRoom)};
    shader::CertifiedConstants constants = given;
    eachRound(meshLooks(item, reach), limits, [&](const Round& round) {
        constants.firstPair = given.firstPair + round.firstPair;
        constants.firstCluster = round.firstCluster;
        constants.endCluster = round.endCluster;
        recorder.record(passes, layout, constants, round.pairs);
    });
}

} // namespace voxtact
