// SPDX-License-Identifier: MIT
#pragma once

#include "device/detector/pass_desc.h"
#include "device/results/results_impl.h"
#include "exact/shared.h"
#include "vulkan/pipeline.h"

namespace voxtact {

/// The pass of the counting method `compute`: a work group for every VOXTACT_COMPUTE_GROUP triangles of a pair.
class ComputePass {
  public:
    [[nodiscard]] static Result<ComputePass> create(ContextImpl& context, const PassDesc& desc);

    /// What a checked batch can still ask too much of: a viewport or a mesh beyond what the pass can do.
    [[nodiscard]] Result<void> check(const Batch& batch) const;

    /// Records the dispatches of a checked batch. Expects the transforms and results of `results` ready for the
    /// compute stage. `boundaryOf` says for each item whether to test the range or to clamp.
    template <class BoundaryOf>
    void record(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                BoundaryOf&& boundaryOf) const {
        std::uint32_t firstPair = 0;
        for (const BatchItem& item : batch.items) {
            recordItem(commandBuffer, batch, item, boundaryOf(item), firstPair, results);
            firstPair += static_cast<std::uint32_t>(item.pairs());
        }
    }

  private:
    ComputePass(ContextImpl& context, const PassDesc& desc) noexcept : context_(&context), desc_(desc) {}

    void recordItem(VkCommandBuffer commandBuffer, const Batch& batch, const BatchItem& item, Boundary boundary,
                    std::uint32_t firstPair, const ResultsImpl& results) const;
    [[nodiscard]] shader::ComputeConstants constantsOf(const Batch& batch, const BatchItem& item) const;

    ContextImpl* context_;
    PassDesc desc_;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

} // namespace voxtact
