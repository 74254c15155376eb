// SPDX-License-Identifier: MIT
#pragma once

#include "detect/results/results_impl.h"
#include "voxtact/detector.h"

namespace voxtact {

[[nodiscard]] bool hasDevicePoses(const Batch& batch) noexcept;

/// Makes the set by which the pass writes to the Results.
[[nodiscard]] Result<void> makeSetupSet(ResultsImpl& results);

/// The pass that makes pairs of poses on the device (shaders/pair_setup.comp): their transforms, and results with a
/// count of zero. It is made once for all detectors of a context: it takes long to compile.
class PairSetup {
  public:
    [[nodiscard]] static Result<PairSetup> create(ContextImpl& context, const DetectorDesc& desc);

    /// Records what the first items of a checked batch are; for the transfer stage, before a barrier to the compute
    /// stage, and record() behind it.
    void recordItems(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results) const;
    /// Records the dispatches. Expects transforms and results ready for the compute stage, and leaves them to be waited
    /// for there.
    void record(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results, std::uint32_t how) const;

  private:
    PairSetup(ContextImpl& context, const DetectorDesc& desc, VkPipeline pipeline) noexcept
        : context_(&context), desc_(desc), pipeline_(pipeline) {}

    void recordItems(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                     std::size_t firstItem) const;
    void recordItem(VkCommandBuffer commandBuffer, const BatchItem& item, shader::PairSetupConstants constants) const;

    ContextImpl* context_;
    DetectorDesc desc_;
    VkPipeline pipeline_; ///< the context's
};

} // namespace voxtact
