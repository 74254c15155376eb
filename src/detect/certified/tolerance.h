// SPDX-License-Identifier: MIT
#pragma once

#include "detect/certified/margin_passes.h"
#include "voxtact/detector.h"

namespace voxtact {

/// What may touch at some pose within a tolerance, after the touch: the passes with a margin, of a mesh that may also
/// be turned (shaders/certified_turn.h) where there is an angle.
class TolerancePass {
  public:
    /// Expects a checked desc with a `poseTolerance` that is not 0 and 0.
    [[nodiscard]] static Result<TolerancePass> create(ContextImpl& context, const DetectorDesc& desc);

    /// Records the rounds for the pairs of an item, which is bound: from `constants.firstPair` on. Waits for what was
    /// dispatched before.
    void record(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                const shader::CertifiedConstants& constants) const;

  private:
    TolerancePass(const MarginPasses& passes, const PoseTolerance& tolerance) noexcept
        : passes_(passes), tolerance_(tolerance) {}

    MarginPasses passes_;
    PoseTolerance tolerance_;
};

/// Records what the passes read of a tolerance with an angle, before them.
void recordTurnLimit(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results,
                     const PoseTolerance& tolerance);

} // namespace voxtact
