// SPDX-License-Identifier: MIT
#pragma once

#include "detect/round_recorder.h"
#include "gpu/pipeline.h"
#include "voxtact/detector.h"

#include <array>

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
    enum Pipeline : std::size_t { Cull, Refine, Expand, Large, Decide, Finish, Count };

    TolerancePass(ContextImpl& context, const PoseTolerance& tolerance) noexcept
        : context_(&context), tolerance_(tolerance) {}

    ContextImpl* context_;
    PoseTolerance tolerance_;
    std::array<Owned<VkPipeline>, Count> pipelines_;
};

} // namespace voxtact
