// SPDX-License-Identifier: MIT
#pragma once

#include "clearance_words.h"
#include "detect/results/results_impl.h"
#include "motion_words.h"

namespace voxtact {

/// Clusters of pairs that one round of the projection conservative has at most. Its queues have room for them, for 32
/// cells for each of them, and so on: shaders/shared.h.
inline constexpr std::uint32_t kLeastQueueRoom = 16;
inline constexpr std::uint32_t kMostQueueRoom = 262144;
/// As many as any device can have: it has 65,535 work groups in a dispatch, and a pass has up to three a cluster.
inline constexpr std::uint32_t kMostRoomAnywhere = 16384;
/// What Results get that were not asked for another.
inline constexpr std::uint32_t kUsualQueueRoom = 2048;
static_assert(VOXTACT_MARGIN_ROOM_LARGE(kMostRoomAnywhere) <= 65535 && VOXTACT_ROOM_NEAREST(kMostRoomAnywhere) <= 65535,
              "Vulkan's least maxComputeWorkGroupCount");
static_assert(VOXTACT_ROOM_BITS(kMostQueueRoom) <= 1U << VOXTACT_FIRST_CELL_SHIFT, "a slot has so many bits");
static_assert(VOXTACT_MARGIN_ROOM_LARGE(kMostQueueRoom) < 1U << VOXTACT_LEFT_SHIFT, "a number has so many bits");

/// Bytes for what PairSetup needs of items.
inline constexpr VkDeviceSize kSetupBytes =
    VkDeviceSize{VOXTACT_SETUP_ITEMS} * VOXTACT_SETUP_WORDS * sizeof(std::uint32_t);

static_assert(sizeof(CertifiedCounters) == VOXTACT_COUNTER_WORDS * sizeof(std::uint32_t));

[[nodiscard]] constexpr VkDeviceSize queueBytes(std::uint32_t room) noexcept {
    return VkDeviceSize{VOXTACT_QUEUE_WORDS(room)} * sizeof(std::uint32_t);
}

/// Where what PairSetup needs of items begins in the buffer of the transforms.
[[nodiscard]] VkDeviceSize setupByte(const ResultsImpl& results) noexcept;
/// Where the queues begin there, behind that.
[[nodiscard]] VkDeviceSize firstQueueByte(const ResultsImpl& results) noexcept;

[[nodiscard]] std::uint32_t firstQueueWord(const ResultsImpl& results) noexcept;
/// Where the CertifiedCounters of a batch are in that buffer.
[[nodiscard]] VkDeviceSize countersByte(const ResultsImpl& results) noexcept;
/// Where the TurnLimit of a pose tolerance is.
[[nodiscard]] VkDeviceSize turnByte(const ResultsImpl& results) noexcept;

static_assert(sizeof(ClearanceResult) == VOXTACT_CLEARANCE_WORDS * sizeof(std::uint32_t));
/// Where the slots of bricks that have bits are in that buffer.
[[nodiscard]] VkDeviceSize bitsByte(const ResultsImpl& results) noexcept;
/// Where VOXTACT_LABEL_* are.
[[nodiscard]] VkDeviceSize labelByte(const ResultsImpl& results) noexcept;
/// Where the clearances are.
[[nodiscard]] VkDeviceSize clearancesByte(const ResultsImpl& results) noexcept;

static_assert(sizeof(ClosestResult) == VOXTACT_CLOSEST_WORDS * sizeof(std::uint32_t));
/// Where they are in that buffer.
[[nodiscard]] VkDeviceSize closestByte(const ResultsImpl& results) noexcept;

/// What a part of that buffer begins at a multiple of.
[[nodiscard]] constexpr VkDeviceSize atPart(VkDeviceSize bytes) noexcept {
    constexpr VkDeviceSize kAlignment = 256;
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}
/// Where the motions are, and what the search along them has.
[[nodiscard]] VkDeviceSize motionsByte(const ResultsImpl& results) noexcept;
[[nodiscard]] VkDeviceSize motionStatesByte(const ResultsImpl& results) noexcept;
static_assert(sizeof(MotionResult) == VOXTACT_MOTION_RESULT_WORDS * sizeof(std::uint32_t));

/// Bytes behind all these for the clearances to so many labels of so many pairs, the first of them of no use.
[[nodiscard]] constexpr VkDeviceSize labelBytes(std::uint32_t pairs, std::uint32_t labels) noexcept {
    return labels == 0 ? 0 : atPart(1) + VkDeviceSize{pairs} * labels * sizeof(ClearanceResult);
}
/// Where they are.
[[nodiscard]] VkDeviceSize labelClearancesByte(const ResultsImpl& results) noexcept;

/// Bytes from the queues on, with room for so many clusters, of Results that have `parts`.
[[nodiscard]] VkDeviceSize bytesFromQueues(std::uint32_t room, const ResultsDesc& parts) noexcept;

/// What a device allows for a room.
struct RoomLimits {
    VkDeviceSize bytes = 0;      ///< of the buffer that the queues are in
    VkDeviceSize usualBytes = 0; ///< of the queues, where nobody asked for a room of more than kMostRoomAnywhere
    std::uint32_t room = 0;      ///< by the work groups of a dispatch
};
/// `maxAllocation`: bytes of its largest allocation.
[[nodiscard]] RoomLimits roomLimits(const VkPhysicalDeviceLimits& device, VkDeviceSize maxAllocation,
                                    const VkPhysicalDeviceMemoryProperties& memory) noexcept;

/// The room for Results, in a buffer whose queues begin at `first`; 0 where it has none.
[[nodiscard]] std::uint32_t queueRoomFor(const ResultsDesc& desc, const RoomLimits& limits,
                                         VkDeviceSize first) noexcept;

/// Records the headers of so many rounds, VOXTACT_HEADERS at most: commands of no work groups, empty queues.
void recordQueueHeaders(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results,
                        std::uint32_t rounds = VOXTACT_HEADERS);
/// Records closest points that no pair has yet.
void recordNoClosest(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results);
/// Records counters of zero.
void recordNoCounters(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results);

} // namespace voxtact
