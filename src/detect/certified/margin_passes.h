// SPDX-License-Identifier: MIT
#pragma once

#include "detect/certified/round_recorder.h"
#include "gpu/pipeline.h"
#include "voxtact/detector.h"

#include <array>
#include <span>

namespace voxtact {

/// The passes of the projection `conservative` with a margin, some variant of them: certified_cull and
/// certified_margin_* of shaders/.
class MarginPasses {
  public:
    static constexpr std::size_t kCount = 6;
    /// Cull, refine, expand, large, decide, finish.
    using Programs = std::array<std::span<const std::uint32_t>, kCount>;

    /// `name` is the variant's.
    [[nodiscard]] static Result<MarginPasses> create(ContextImpl& context, const Programs& programs,
                                                     std::span<const ShaderConstant> constants, const char* name);

    /// The rounds of an item in queues with so much room. `reach`: mm, no point of the mesh is looked at farther from
    /// its place.
    [[nodiscard]] RoundCut cutOf(const BatchItem& item, std::uint32_t queueRoom, double reach) const noexcept;

    /// Records them for the pairs of that item, which is bound: from `constants.firstPair` on, or those that are
    /// listed. Waits for what was dispatched before.
    void record(RoundRecorder& recorder, VkPipelineLayout layout, const shader::CertifiedConstants& constants,
                const RoundCut& cut, const std::optional<ListedPairs>& listed = {}) const;

  private:
    explicit MarginPasses(ContextImpl& context) noexcept : context_(&context) {}

    ContextImpl* context_;
    std::array<VkPipeline, kCount> pipelines_{};
};

} // namespace voxtact
