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

RoundCut MarginPasses::cutOf(const BatchItem& item, std::uint32_t queueRoom, double reach) const noexcept {
    const MeshLooks looks = meshLooks(item, reach);
    return {looks,
            {.clusters = clustersOf(looks, queueRoom, false),
             .pairs = context_->limits.maxComputeWorkGroupCount[1],
             .looks = looksOfRound(queueRoom)}};
}

void MarginPasses::record(RoundRecorder& recorder, VkPipelineLayout layout, const shader::CertifiedConstants& constants,
                          const RoundCut& cut, const std::optional<ListedPairs>& listed) const {
    std::array<RoundPass, kCount> passes{};
    for (std::size_t i = 0; i < kCount; ++i) {
        passes[i] = {pipelines_[i], kMarginPasses[i].queue};
    }
    recorder.record(passes, layout, constants, cut, listed);
}

} // namespace voxtact
