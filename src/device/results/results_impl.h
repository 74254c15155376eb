// SPDX-License-Identifier: MIT
#pragma once

#include "device/outputs/output_store.h"
#include "voxtact/detector.h"
#include "vulkan/context_impl.h"

namespace voxtact {

struct ResultsImpl {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    bool certified = false;       ///< for certified detectors
    std::uint32_t outputBits = 0; ///< outputsConstant() of the outputs that have room
    std::uint32_t maxPairs = 0;
    std::uint32_t pairs = 0;         ///< of the batch recorded last
    std::uint32_t timestampBits = 0; ///< valid bits; 0: no timestamps
    bool detectRecorded = false;     ///< cmdDetect() was recorded
    bool readBackRecorded = false;   ///< cmdReadBack() came after the last cmdDetect()
    bool counted = false;            ///< the batch recorded last has CertifiedCounters
    std::uint32_t copies = 0;        ///< that cmdReadBack() recorded; the last thing that a copy writes is its number
    std::uint32_t maxTransforms = 0; ///< at least maxPairs
    std::uint32_t queueRoom = 0;     ///< in clusters: src/exact/shared.h; 0 where not `certified`
    Buffer transforms{};             ///< maxTransforms PairTransforms, and behind them the queues of that projection
    BufferRange results{};           ///< maxPairs PairResults, of `ownResults` or of the caller's buffer
    Buffer ownResults{};             ///< empty with ResultsDesc::into
    Buffer readBack{};               ///< the host's copy, CertifiedCounters, the number of it; empty when not asked for
    Buffer staging{};                ///< ResultsDesc::staged: of maxPairs, the most that any projection has; else empty
    DescriptorSet stagedPoses{};     ///< of `staging`: doubles, a Mat4 a pose; null where that is empty
    std::uint32_t stagedPoseRoom = 0; ///< of those, where a shader reads them
    Owned<VkQueryPool> occlusion{};   ///< maxPairs queries
    Owned<VkQueryPool> timestamps{};  ///< two, or none
    DescriptorSet descriptors{};
    DescriptorSet setup{};                  ///< VOXTACT_SET_SETUP
    std::unique_ptr<OutputStore> outputs{}; ///< null without outputs

    /// Where the parts of `readBack` begin that are behind the results.
    [[nodiscard]] VkDeviceSize countersOnHost() const noexcept { return VkDeviceSize{maxPairs} * sizeof(PairResult); }
    [[nodiscard]] VkDeviceSize copyNumberOnHost() const noexcept {
        return countersOnHost() + sizeof(CertifiedCounters);
    }
    [[nodiscard]] VkDeviceSize readBackBytes() const noexcept { return copyNumberOnHost() + sizeof copies; }
};

} // namespace voxtact
