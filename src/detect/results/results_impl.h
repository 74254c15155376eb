// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/rigid_motion.h"
#include "detect/outputs/output_store.h"
#include "gpu/context_impl.h"
#include "voxtact/detector.h"

namespace voxtact {

struct ResultsImpl {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    std::uint32_t maxPairs = 0;
    std::uint32_t pairs = 0;         ///< of the batch recorded last
    std::uint32_t timestampBits = 0; ///< valid bits; 0: no timestamps
    bool detectRecorded = false;     ///< cmdDetect() was recorded
    bool readBackRecorded = false;   ///< cmdReadBack() came after the last cmdDetect()
    bool counted = false;            ///< the batch recorded last has CertifiedCounters
    bool clearances = false;         ///< there is room for those of maxPairs, behind the queues
    bool closest = false;            ///< there is room for ClosestResults, too, behind these
    bool pointed = false;            ///< the batch recorded last has them
    std::uint32_t labelRoom = 0;     ///< labels of each of maxPairs that there is room for, behind all these
    /// Of the batch recorded last, where clearances to them were measured: Batch::labels.
    std::optional<std::vector<std::int32_t>> labels{};
    bool motionRoom = false; ///< there is room for motions of maxPairs, behind what clearances and closest points have
    /// Of the batch recorded last, where they are looked at: of each pair the one that begins with its pose.
    std::optional<std::vector<std::optional<RigidMotion>>> motions{};
    std::optional<double> maximum{}; ///< of the batch recorded last, where it has clearances: ClearanceSearch
    std::uint32_t copies = 0;        ///< that cmdReadBack() recorded; the last thing that a copy writes is its number
    std::uint32_t maxTransforms = 0; ///< at least maxPairs
    std::uint32_t queueRoom = 0;     ///< of the projection conservative, in clusters: shaders/shared.h
    Buffer transforms{};             ///< maxTransforms PairTransforms, and behind them the queues of that projection
    BufferRange results{};           ///< maxPairs PairResults, of `ownResults` or of the caller's buffer
    Buffer ownResults{};             ///< empty with ResultsDesc::into
    Buffer readBack{}; ///< the host's copy, CertifiedCounters, the number of it, ClearanceResults, ClosestResults,
                       ///< ClearanceResults of labels, MotionResults; empty when not asked for
    Buffer staging{};  ///< ResultsDesc::staged: of maxPairs, the most that any projection has; else empty
    DescriptorSet stagedPoses{};      ///< of `staging`: doubles, a Mat4 a pose; null where that is empty
    std::uint32_t stagedPoseRoom = 0; ///< of those, where a shader reads them
    Owned<VkQueryPool> occlusion{};   ///< maxPairs queries
    Owned<VkQueryPool> timestamps{};  ///< two, or none
    DescriptorSet descriptors{};
    DescriptorSet setup{};                  ///< VOXTACT_SET_SETUP
    std::unique_ptr<OutputStore> outputs{}; ///< null without room for outputs

    /// Where the parts of `readBack` begin that are behind the results.
    [[nodiscard]] VkDeviceSize countersOnHost() const noexcept { return VkDeviceSize{maxPairs} * sizeof(PairResult); }
    [[nodiscard]] VkDeviceSize copyNumberOnHost() const noexcept {
        return countersOnHost() + sizeof(CertifiedCounters);
    }
    [[nodiscard]] VkDeviceSize clearancesOnHost() const noexcept { return copyNumberOnHost() + sizeof copies; }
    [[nodiscard]] VkDeviceSize closestOnHost() const noexcept {
        return clearancesOnHost() + (clearances ? VkDeviceSize{maxPairs} * sizeof(ClearanceResult) : 0);
    }
    [[nodiscard]] VkDeviceSize labelsOnHost() const noexcept {
        return closestOnHost() + (closest ? VkDeviceSize{maxPairs} * sizeof(ClosestResult) : 0);
    }
    [[nodiscard]] VkDeviceSize motionsOnHost() const noexcept {
        return labelsOnHost() + VkDeviceSize{maxPairs} * labelRoom * sizeof(ClearanceResult);
    }
    [[nodiscard]] VkDeviceSize readBackBytes() const noexcept {
        return motionsOnHost() + (motionRoom ? VkDeviceSize{maxPairs} * sizeof(MotionResult) : 0);
    }
};

} // namespace voxtact
