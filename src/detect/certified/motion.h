// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/rigid_motion.h"
#include "detect/certified/margin_passes.h"
#include "detect/results/results_impl.h"
#include "voxtact/detector.h"

#include <optional>
#include <span>
#include <vector>

namespace voxtact {

/// The search along motions, which begins with the touch at the first poses: a step looks at the middle of a piece of
/// each segment's way, by the passes of the touch, and at how far the mesh goes from there, by those with a margin
/// (shaders/certified_move.h). How many there are follows from the longest way; a step has no work groups for segments
/// that are done.
class MotionPass {
  public:
    /// The passes that look at one pose of each pair, made with VOXTACT_CONSTANT_LISTED, and their rounds of the item.
    struct Touch {
        std::span<const RoundPass> passes;
        RoundCut cut;
    };

    /// Expects a checked desc with `motion`.
    [[nodiscard]] static Result<MotionPass> create(ContextImpl& context, const DetectorDesc& desc);

    /// Records the search for the segments of an item, which is bound: the pairs from `constants.firstPair` on. Waits
    /// for what was dispatched before.
    void record(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                const shader::CertifiedConstants& constants, const Touch& touch) const;

  private:
    MotionPass(ContextImpl& context, const MotionSearch& search, const MarginPasses& look, VkPipeline step) noexcept
        : context_(&context), search_(search), look_(look), step_(step) {}

    /// `step`: of an item that is bound; all but its pairs are set.
    void recordStep(RoundRecorder& recorder, VkPipelineLayout layout, shader::MotionConstants step,
                    const BatchItem& item, std::uint32_t firstPair) const;

    ContextImpl* context_;
    MotionSearch search_;
    MarginPasses look_;
    VkPipeline step_;
};

/// The motions of a checked batch, by pair: from its pose to the next one; of the last pose of an item none. Refuses a
/// batch that has no room, poses on the device, meshes that the host does not know, and two poses that differ by more
/// than a rigid motion.
[[nodiscard]] Result<std::vector<std::optional<RigidMotion>>> motionsOf(const Batch& batch, const MotionSearch& search,
                                                                        const ResultsImpl& results);

/// Records what the search begins with, for all pairs of such a batch.
void recordMotions(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                   const ResultsImpl& results, const MotionSearch& search);

} // namespace voxtact
