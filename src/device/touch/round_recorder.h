// SPDX-License-Identifier: MIT
#pragma once

#include "device/results/results_impl.h"
#include "device/touch/certified_rounds.h"
#include "exact/shared.h"

#include <span>

namespace voxtact {

/// A pass of a round, and the queue that it empties.
struct RoundPass {
    VkPipeline pipeline;
    std::uint32_t queue;
};

/// Instead of a queue: the first pass has none.
inline constexpr std::uint32_t kNoQueue = VOXTACT_QUEUES;

/// Behind a pass, for the next one: what it has put into queues.
void queuesBarrier(const ContextImpl& context, VkCommandBuffer commandBuffer);

/// Records the rounds of a batch of the projection certified, with a header of queues for each.
class RoundRecorder {
  public:
    /// `tally`: the pipeline that counts what the rounds did, or null.
    RoundRecorder(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results,
                  VkPipeline tally) noexcept
        : context_(&context), commandBuffer_(commandBuffer), results_(&results), tally_(tally) {}

    /// The rounds of an item's pairs, from that of `given` on; its headerWord is not examined. Waits for what was
    /// dispatched before. Where the last two passes have one pipeline, they do not wait for each other.
    void record(std::span<const RoundPass> passes, VkPipelineLayout layout, const shader::CertifiedConstants& given,
                const RoundCut& cut);
    /// Counts what the rounds did that are not counted yet.
    void finish(VkPipelineLayout layout);

  private:
    void recordRound(std::span<const RoundPass> passes, VkPipelineLayout layout,
                     const shader::CertifiedConstants& given, std::uint32_t pairs);
    void dispatch(const RoundPass& pass, const shader::CertifiedConstants& constants, std::uint32_t pairs);
    void renewHeaders(VkPipelineLayout layout);
    /// Counts what the last `rounds` rounds did; between barriers for compute shaders.
    void recordTally(VkPipelineLayout layout, std::uint32_t rounds);

    const ContextImpl* context_;
    VkCommandBuffer commandBuffer_;
    const ResultsImpl* results_;
    VkPipeline tally_;
    std::uint32_t rounds_ = 0;
};

} // namespace voxtact
