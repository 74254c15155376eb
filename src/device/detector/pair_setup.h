// SPDX-License-Identifier: MIT
#pragma once

#include "device/detector/pass_desc.h"
#include "device/results/results_impl.h"

namespace voxtact {

[[nodiscard]] bool hasDevicePoses(const Batch& batch) noexcept;

/// Makes the sets by which the pass writes to the Results and reads what they have staged.
[[nodiscard]] Result<void> makeSetupSets(ResultsImpl& results);

/// The pass that makes pairs of poses on the device (shaders/count/pair_setup.comp): their transforms, and results with
/// a count of zero. It is made once for all detectors of a context: it takes long to compile.
class PairSetup {
  public:
    /// Unsupported, with what is missing named, where the device has no doubles that round as the host's.
    [[nodiscard]] static Result<PairSetup> create(ContextImpl& context, const PassDesc& desc);

    /// Writes the poses that the host has of a checked batch to where record() reads them, in Results that stage them.
    /// False where the host is to make the pairs of them: there are few, or more than a shader can see of the staging
    /// memory, or the device may lose some of what is made of them.
    [[nodiscard]] bool stagePoses(const Batch& batch, const ResultsImpl& results) const noexcept;

    /// Records what the first items of the batch are; for the transfer stage, before a barrier to the compute stage,
    /// and record() behind it. `staged` is what stagePoses() has said.
    void recordItems(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results, bool staged) const;
    /// Records the dispatches. Expects transforms and results ready for the compute stage, and leaves them to be waited
    /// for there.
    void record(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results, bool staged,
                std::uint32_t how) const;

  private:
    /// Where the poses of an item are, and the program for such poses.
    struct Source {
        VkPipeline pipeline;
        VkDescriptorSet poses;
        std::uint32_t firstWord;
        std::uint32_t words; ///< from one pose to the next
    };

    PairSetup(ContextImpl& context, const PassDesc& desc) noexcept : context_(&context), desc_(desc) {}

    /// Of an item whose first pair that is.
    [[nodiscard]] Source sourceOf(const BatchItem& item, const ResultsImpl& results, std::uint32_t firstPair) const;
    void recordItems(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results, bool staged,
                     std::size_t firstItem) const;
    void recordItem(VkCommandBuffer commandBuffer, const Source& source, std::uint32_t pairs,
                    shader::PairSetupConstants constants) const;

    ContextImpl* context_;
    PassDesc desc_;
    VkPipeline pipeline_ = VK_NULL_HANDLE;     ///< the context's
    VkPipeline hostPipeline_ = VK_NULL_HANDLE; ///< for poses of the host's
};

} // namespace voxtact
