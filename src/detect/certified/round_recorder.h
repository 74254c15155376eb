// SPDX-License-Identifier: MIT
#pragma once

#include "detect/certified/certified_rounds.h"
#include "detect/certified/open_pairs.h"
#include "detect/results/results_impl.h"
#include "shared.h"

#include <optional>
#include <span>

namespace voxtact {

/// A pass of a round, and the queue that it empties.
struct RoundPass {
    VkPipeline pipeline;
    std::uint32_t queue;
};

/// In place of a queue: the first pass has none.
inline constexpr std::uint32_t kNoQueue = VOXTACT_QUEUES;

/// Behind a pass, for the next one: what it has put into queues.
void queuesBarrier(const ContextImpl& context, VkCommandBuffer commandBuffer);

/// Records the rounds of a batch of the projection conservative, with a header of queues for each.
class RoundRecorder {
  public:
    /// `tally`: the pipeline that counts what the rounds did, or null.
    RoundRecorder(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results,
                  VkPipeline tally) noexcept
        : context_(&context), commandBuffer_(commandBuffer), results_(&results), tally_(tally) {}

    /// The rounds of an item's pairs, from that of `given` on; its headerWord is not looked at. Waits for what was
    /// dispatched before. Where the last two passes have one pipeline, they do not wait for each other. `listed`: of
    /// these pairs, in place of all; then the first pass has VOXTACT_CONSTANT_LISTED.
    void record(std::span<const RoundPass> passes, VkPipelineLayout layout, const shader::CertifiedConstants& given,
                const RoundCut& cut, const std::optional<ListedPairs>& listed = {});
    /// Counts what the rounds did that are not counted yet.
    void finish(VkPipelineLayout layout);

    [[nodiscard]] VkCommandBuffer commandBuffer() const noexcept { return commandBuffer_; }
    [[nodiscard]] const ResultsImpl& results() const noexcept { return *results_; }

  private:
    /// How the first pass of a round knows its pairs: there are so many, or a command of the device says it.
    struct RoundPairs {
        std::uint32_t pairs;
        std::optional<std::uint32_t> commandWord;
    };
    void recordRound(std::span<const RoundPass> passes, VkPipelineLayout layout,
                     const shader::CertifiedConstants& given, const RoundPairs& of);
    void dispatch(const RoundPass& pass, const shader::CertifiedConstants& constants, const RoundPairs& of);
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
