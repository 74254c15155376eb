// SPDX-License-Identifier: MIT
#pragma once

#include "detect/certified/clearance_programs.h"
#include "detect/certified/closest.h"
#include "detect/certified/round_recorder.h"
#include "voxtact/detector.h"

#include <array>
#include <optional>
#include <span>

namespace voxtact {

/// The search for clearances, after the touch: a step looks at boxes only, and then each at all that is as near as the
/// pair asks (shaders/certified_clearance*). How many there are follows from the volume alone; a step has no work
/// groups for pairs that are done. Where clearances to labels are wanted, each label is a search more, by the same
/// passes.
class ClearancePass {
  public:
    /// Expects a checked desc with `clearance`.
    [[nodiscard]] static Result<ClearancePass> create(ContextImpl& context, const DetectorDesc& desc);

    /// Records the search for the pairs of an item, which is bound: from `constants.firstPair` on. Waits for what was
    /// dispatched before. `labels`: Batch::labels.
    void record(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                const shader::CertifiedConstants& constants, std::span<const std::int32_t> labels) const;

  private:
    /// What one search is about.
    struct Search {
        const ClearancePipelines& pipelines;
        VkPipelineLayout layout;
        const BatchItem& item;
        shader::CertifiedConstants constants;
        shader::ClearanceConstants search;
        OpenPairs open;
    };

    ClearancePass(ContextImpl& context, const DetectorDesc& desc) noexcept
        : context_(&context), desc_(*desc.clearance), anyOpacity_(desc.labelsAtAnyOpacity) {}

    void recordAll(RoundRecorder& recorder, const Search& of) const;
    void recordLabels(RoundRecorder& recorder, const Search& all, std::span<const std::int32_t> labels) const;
    /// What was known of cells is not known of the next search's; and that one is about `label` (VOXTACT_LABEL_*).
    void recordBegin(RoundRecorder& recorder, const OpenPairs& open,
                     const std::optional<std::array<std::uint32_t, 4>>& label) const;
    void recordSearch(RoundRecorder& recorder, VkPipelineLayout layout,
                      const shader::ClearanceConstants& constants) const;
    [[nodiscard]] RoundCut cutOf(const Search& of, std::uint32_t step) const noexcept;
    void recordStep(RoundRecorder& recorder, const Search& of, std::uint32_t step) const;

    ContextImpl* context_;
    ClearanceSearch desc_;
    bool anyOpacity_;
    ClearancePipelines pipelines_{};
    std::optional<ClearancePipelines> ofLabels_;    ///< with DetectorDesc::labelClearances
    VkPipelineLayout labelLayout_ = VK_NULL_HANDLE; ///< of these
    VkPipeline search_ = VK_NULL_HANDLE;
    std::optional<ClosestPass> closest_; ///< with DetectorDesc::closest
};

/// Refuses a checked batch that has no label maps, or no room, for what is asked about labels.
[[nodiscard]] Result<void> checkLabelClearances(const ContextImpl& context, const Batch& batch,
                                                const ResultsImpl& results);

} // namespace voxtact
