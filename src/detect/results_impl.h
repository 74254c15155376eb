// SPDX-License-Identifier: MIT
#pragma once

#include "detect/output_store.h"
#include "gpu/memory.h"
#include "voxtact/detector.h"

namespace voxtact {

struct ResultsImpl {
    ContextImpl& context;
    std::uint32_t maxPairs = 0;
    std::uint32_t pairs = 0;         ///< of the batch recorded last
    std::uint32_t timestampBits = 0; ///< valid bits; 0: no timestamps
    bool readBackRecorded = false;   ///< cmdReadBack() came after the last cmdDetect()
    std::uint32_t maxTransforms = 0; ///< at least maxPairs
    Buffer transforms{};             ///< maxTransforms PairTransforms
    Buffer results{};                ///< maxPairs PairResults
    Buffer readBack{};               ///< the host's copy; empty when not asked for
    Owned<VkQueryPool> occlusion{};  ///< maxPairs queries
    Owned<VkQueryPool> timestamps{}; ///< two, or none
    DescriptorSet descriptors{};
    std::unique_ptr<OutputStore> outputs{}; ///< null without room for outputs
};

} // namespace voxtact
