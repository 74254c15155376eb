// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/pipeline.h"

#include <array>
#include <cstddef>

namespace voxtact {

/// The passes of a step of the search for clearances.
enum class ClearanceProgram : std::size_t {
    Cull,
    Scout,
    Refine,
    Expand,
    Bits,
    Near,
    Sift,
    Probes,
    Probe,
    Nearest,
    Large,
    Narrow,
    Again,
    Decide,
    Finish,
    Count
};

/// The pipelines of a step: about all that is opaque, or about what of it has a label.
using ClearancePipelines = std::array<VkPipeline, static_cast<std::size_t>(ClearanceProgram::Count)>;

/// `closest`: what proves distances is kept. Of labels it is not.
[[nodiscard]] Result<ClearancePipelines> makeClearancePipelines(ContextImpl& context, bool counters, bool closest);
[[nodiscard]] Result<ClearancePipelines> makeLabelPipelines(ContextImpl& context, bool counters,
                                                            VkPipelineLayout layout);

} // namespace voxtact
