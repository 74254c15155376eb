// SPDX-License-Identifier: MIT
#pragma once

#include "detect/certified/round_recorder.h"
#include "gpu/pipeline.h"
#include "voxtact/detector.h"

namespace voxtact {

/// Closest points, after the search for clearances: of what the passes kept that proves the distance of each pair, an
/// opaque point, and then its ClosestResult (shaders/certified_clearance_place.comp and _points.comp).
class ClosestPass {
  public:
    [[nodiscard]] static Result<ClosestPass> create(ContextImpl& context);

    /// Records both for the pairs of an item, which is bound: from `constants.firstPair` on. Waits for what was
    /// dispatched before. `constants` are those of the search.
    void record(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                const shader::CertifiedConstants& constants) const;

  private:
    explicit ClosestPass(ContextImpl& context) noexcept : context_(&context) {}

    ContextImpl* context_;
    VkPipeline place_ = VK_NULL_HANDLE;
    VkPipeline points_ = VK_NULL_HANDLE;
};

} // namespace voxtact
