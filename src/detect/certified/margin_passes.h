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

    /// Records the rounds for the pairs of an item, which is bound: from `constants.firstPair` on. Waits for what was
    /// dispatched before. `reach`: mm, no point of the mesh is looked at farther from its place.
    void record(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                const shader::CertifiedConstants& constants, double reach) const;

  private:
    explicit MarginPasses(ContextImpl& context) noexcept : context_(&context) {}

    ContextImpl* context_;
    std::array<VkPipeline, kCount> pipelines_{};
};

} // namespace voxtact
