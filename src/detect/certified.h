// SPDX-License-Identifier: MIT
#pragma once

#include "detect/results_impl.h"
#include "gpu/pipeline.h"
#include "shared.h"
#include "voxtact/detector.h"

namespace voxtact {

/// The passes of the projection `conservative`: the first has a work group for every VOXTACT_COMPUTE_GROUP triangles of
/// a pair, a cluster where the mesh has them; the second goes through the triangles that the first left open.
class CertifiedPass {
  public:
    [[nodiscard]] static Result<CertifiedPass> create(ContextImpl& context, const DetectorDesc& desc);

    /// What a checked batch can still lack or ask too much of: bricks, a table that the host knows, a mesh that shaders
    /// can read and that is not too large.
    [[nodiscard]] Result<void> check(const Batch& batch) const;

    /// Records the dispatches of a checked batch. Expects the transforms and results of `results` ready for the
    /// compute stage. `boundaryOf` is not asked: points outside the domain never count.
    template <class BoundaryOf>
    void record(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                const BoundaryOf& /*boundaryOf*/) const {
        recordFirst(commandBuffer, batch, results);
        recordAgain(commandBuffer, batch, results);
    }

  private:
    CertifiedPass(ContextImpl& context, const DetectorDesc& desc) noexcept : context_(&context), desc_(desc) {}

    void recordFirst(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results) const;
    void recordAgain(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results) const;
    /// Binds a pass for each item, and has `dispatch` called for each range of its pairs that one dispatch may have.
    template <class Dispatch>
    void recordItems(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results, VkPipeline pipeline,
                     const Dispatch& dispatch) const;
    [[nodiscard]] shader::CertifiedConstants constantsOf(const Batch& batch, const BatchItem& item) const;

    ContextImpl* context_;
    DetectorDesc desc_;
    Owned<VkPipeline> first_;
    Owned<VkPipeline> again_;
};

} // namespace voxtact
