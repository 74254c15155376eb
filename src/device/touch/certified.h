// SPDX-License-Identifier: MIT
#pragma once

#include "core/transfer/opaque_numbers.h"
#include "device/detector/pass_desc.h"
#include "device/results/results_impl.h"
#include "device/touch/round_recorder.h"
#include "exact/shared.h"
#include "vulkan/pipeline.h"

#include <array>
#include <vector>

namespace voxtact {

inline constexpr std::size_t kCertifiedPasses = 6;

/// The passes of the projection `certified`, in rounds of as many clusters as the queues between them have room for
/// (shaders/touch/certified_*.comp).
class CertifiedPass {
  public:
    [[nodiscard]] static Result<CertifiedPass> create(ContextImpl& context, const PassDesc& desc);

    /// What a checked batch can still lack: bricks, a table that the host knows, a mesh that shaders can read.
    [[nodiscard]] Result<void> check(const Batch& batch) const;

    /// How many rounds a checked batch has, at most.
    [[nodiscard]] std::uint32_t rounds(const Batch& batch, const ResultsImpl& results) const noexcept;

    /// Records the dispatches of a checked batch. Expects the transforms, queue headers and results of `results` ready
    /// for the compute stage. `boundaryOf` is not asked: points outside the domain never count.
    template <class BoundaryOf>
    void record(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                const BoundaryOf& /*boundaryOf*/) const {
        record(commandBuffer, batch, results);
    }

  private:
    CertifiedPass(ContextImpl& context, const PassDesc& desc) noexcept : context_(&context), desc_(desc) {}

    void record(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results) const;
    [[nodiscard]] RoundCut cutOf(const BatchItem& item, std::uint32_t queueRoom) const noexcept;
    [[nodiscard]] std::vector<RoundPass> passesOfRound() const;
    [[nodiscard]] shader::CertifiedConstants constantsOf(const BatchItem& item, const OpaqueNumbers& opaque,
                                                         const ResultsImpl& results) const;

    ContextImpl* context_;
    PassDesc desc_;
    std::array<VkPipeline, kCertifiedPasses> pipelines_{};
    VkPipeline tally_ = VK_NULL_HANDLE; ///< with counters
};

} // namespace voxtact
