// SPDX-License-Identifier: MIT
#pragma once

#include "detect/certified/certified_rounds.h"
#include "detect/results/results_impl.h"
#include "shared.h"

#include <cstdint>

namespace voxtact {

/// What the device has listed for the rounds of a look, in words of the buffer of the transforms.
struct ListedPairs {
    std::uint32_t listWord = 0;
    std::uint32_t commandWord = 0; ///< of the first pass of the first rounds, those of as many pairs as go into one
};

/// The pairs of an item that a search still looks at, listed on the device between its steps (shaders/open_pairs.h).
/// Recorded are as many rounds as all pairs of the item take; those that are not needed have no work groups.
class OpenPairs {
  public:
    /// For an item of a batch for `results`, which have room for clearances or motions.
    OpenPairs(const ResultsImpl& results, const BatchItem& item) noexcept;

    /// Records that nothing is listed. Before a barrier for the compute stage, behind one for transfers.
    void recordNone(const ContextImpl& context, VkCommandBuffer commandBuffer) const;

    /// What the pass that lists the pairs of a step is told. Steps follow each other by one. `touch`: how the step's
    /// touch is cut, if it has one. `look`: the rounds that look around.
    [[nodiscard]] shader::OpenPairs listing(std::uint32_t step, const RoundCut* touch, const RoundCut& look) const;
    /// The rounds of that step.
    [[nodiscard]] ListedPairs touches(std::uint32_t step) const noexcept;
    [[nodiscard]] ListedPairs looks(std::uint32_t step) const noexcept;

  private:
    [[nodiscard]] std::uint32_t setOf(std::uint32_t step) const noexcept;
    [[nodiscard]] std::uint32_t listWord() const noexcept;

    const ResultsImpl* results_;
    std::uint32_t pairs_;
    std::uint32_t word_; ///< of that buffer, where the sets begin
};

} // namespace voxtact
