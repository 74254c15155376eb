// SPDX-License-Identifier: MIT
#pragma once

#include "detect/closest.h"
#include "detect/round_recorder.h"
#include "gpu/pipeline.h"
#include "voxtact/detector.h"

#include <array>
#include <optional>

namespace voxtact {

/// The search for clearances, after the touch: a step looks at boxes only, and then each at all that is as near as the
/// pair asks (shaders/certified_clearance*). How many there are follows from the volume alone; of pairs that are done,
/// a step looks at nothing.
class ClearancePass {
  public:
    /// Expects a checked desc with `clearance`.
    [[nodiscard]] static Result<ClearancePass> create(ContextImpl& context, const DetectorDesc& desc);

    /// Records the search for the pairs of an item, which is bound: from `constants.firstPair` on. Waits for what was
    /// dispatched before.
    void record(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                const shader::CertifiedConstants& constants) const;

  private:
    enum Pipeline : std::size_t {
        Cull,
        Scout,
        Refine,
        Expand,
        Bits,
        Near,
        Sift,
        Probes,
        Probe,
        Nearest,
        Large,
        Narrow,
        Again,
        Decide,
        Finish,
        Search,
        Count
    };

    ClearancePass(ContextImpl& context, const ClearanceSearch& desc) noexcept : context_(&context), desc_(desc) {}

    /// What was known of cells is not known of the next item's.
    void recordNoBits(RoundRecorder& recorder) const;
    void recordSearch(RoundRecorder& recorder, VkPipelineLayout layout,
                      const shader::ClearanceConstants& constants) const;
    void recordStep(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                    const shader::CertifiedConstants& given, bool boxesOnly) const;

    ContextImpl* context_;
    ClearanceSearch desc_;
    std::array<Owned<VkPipeline>, Count> pipelines_;
    std::optional<ClosestPass> closest_; ///< with DetectorDesc::closest
};

} // namespace voxtact
