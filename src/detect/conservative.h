// SPDX-License-Identifier: MIT
#pragma once

#include "detect/results_impl.h"
#include "gpu/pipeline.h"
#include "shared.h"
#include "voxtact/detector.h"

namespace voxtact {

/// The pass of the projection `conservative`: a work group for every VOXTACT_COMPUTE_GROUP triangles of a pair, a
/// cluster where the mesh has them.
class ConservativePass {
  public:
    [[nodiscard]] static Result<ConservativePass> create(ContextImpl& context, const DetectorDesc& desc);

    /// What a checked batch can still lack or ask too much of: bricks, a table that the host knows, a mesh that shaders
    /// can read and that is not too large.
    [[nodiscard]] Result<void> check(const Batch& batch) const;

    /// Records the dispatches of a checked batch. Expects the transforms and results of `results` ready for the
    /// compute stage. `boundaryOf` is not asked: points outside the domain never count.
    template <class BoundaryOf>
    void record(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                const BoundaryOf& /*boundaryOf*/) const {
        std::uint32_t firstPair = 0;
        for (const BatchItem& item : batch.items) {
            recordItem(commandBuffer, batch, item, firstPair, results);
            firstPair += static_cast<std::uint32_t>(item.world_from_object.size());
        }
    }

  private:
    ConservativePass(ContextImpl& context, const DetectorDesc& desc) noexcept : context_(&context), desc_(desc) {}

    void recordItem(VkCommandBuffer commandBuffer, const Batch& batch, const BatchItem& item, std::uint32_t firstPair,
                    const ResultsImpl& results) const;
    [[nodiscard]] shader::CertifiedConstants constantsOf(const Batch& batch, const BatchItem& item) const;

    ContextImpl* context_;
    DetectorDesc desc_;
    Owned<VkPipeline> pipeline_;
};

} // namespace voxtact
