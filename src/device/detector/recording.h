// SPDX-License-Identifier: MIT
#pragma once

#include "device/detector/pair_setup.h"
#include "device/results/results_impl.h"

#include <optional>

namespace voxtact {

/// PairTransforms whose room a pair takes in the buffer of the transforms: the most of all projections.
inline constexpr std::uint32_t kMostTransformsPerPair = 2;
[[nodiscard]] std::uint32_t transformsPerPair(Projection projection) noexcept;

/// What every pass needs before it: the transforms of a checked batch, and results of zero that say which pair they
/// are. Waits for whatever still uses an earlier batch of the same Results. Leaves them ready for shaders, and the
/// queries reset where the method counts by query. `setup` is the detector's, for poses on the device and for staged
/// ones; `rounds` are those of the projection certified, whose first VOXTACT_HEADERS it makes ready.
[[nodiscard]] Result<void> prepareResults(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                                          const ResultsImpl& results, const PassDesc& desc,
                                          const std::optional<PairSetup>& setup = std::nullopt,
                                          std::uint32_t rounds = 0);

/// What every pass needs after it: queries are copied over the counts, and the results made visible to what follows.
void publishResults(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results,
                    const PassDesc& desc);

} // namespace voxtact
