// SPDX-License-Identifier: MIT
#pragma once

#include "device/results/results_impl.h"
#include "exact/shared.h"

namespace voxtact {

/// Clusters of pairs that one round of the projection certified has at most. Its queues have room for them, for 32
/// cells for each of them, and so on: src/exact/shared.h.
inline constexpr std::uint32_t kLeastQueueRoom = 16;
inline constexpr std::uint32_t kMostQueueRoom = 262144;
/// Every device has room for them: a pass has at most one work group a cluster, a dispatch 65,535.
inline constexpr std::uint32_t kMostRoomAnywhere = 16384;
/// What Results get that were not asked for another.
inline constexpr std::uint32_t kUsualQueueRoom = 2048;
static_assert(kMostRoomAnywhere <= 65535, "Vulkan's least maxComputeWorkGroupCount");
static_assert(VOXTACT_ROOM_LARGE(kMostQueueRoom) < 1U << VOXTACT_LEFT_SHIFT, "the number fits");

/// Bytes for what PairSetup needs of items.
inline constexpr VkDeviceSize kSetupBytes =
    VkDeviceSize{VOXTACT_SETUP_ITEMS} * VOXTACT_SETUP_WORDS * sizeof(std::uint32_t);

/// Bytes for the opaque values of an item.
inline constexpr VkDeviceSize kOpaqueBytes = VkDeviceSize{VOXTACT_OPAQUE_WORDS} * sizeof(std::uint32_t);

static_assert(sizeof(CertifiedCounters) == VOXTACT_COUNTER_WORDS * sizeof(std::uint32_t));

[[nodiscard]] constexpr VkDeviceSize queueBytes(std::uint32_t room) noexcept {
    return VkDeviceSize{VOXTACT_QUEUE_WORDS(room)} * sizeof(std::uint32_t);
}

/// Where what PairSetup needs of items begins in the buffer of the transforms.
[[nodiscard]] VkDeviceSize setupByte(const ResultsImpl& results) noexcept;
/// Where the opaque values of an item are, behind that.
[[nodiscard]] VkDeviceSize opaqueByte(const ResultsImpl& results) noexcept;
/// Where the queues begin, behind these.
[[nodiscard]] VkDeviceSize firstQueueByte(const ResultsImpl& results) noexcept;

[[nodiscard]] std::uint32_t firstQueueWord(const ResultsImpl& results) noexcept;
/// Where the CertifiedCounters of a batch are in that buffer.
[[nodiscard]] VkDeviceSize countersByte(const ResultsImpl& results) noexcept;

/// What a part of that buffer begins at a multiple of.
[[nodiscard]] constexpr VkDeviceSize atPart(VkDeviceSize bytes) noexcept {
    constexpr VkDeviceSize kAlignment = 256;
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

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

/// Records the headers of a number of rounds, at most VOXTACT_HEADERS: commands of no work groups, empty queues.
void recordQueueHeaders(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results,
                        std::uint32_t rounds = VOXTACT_HEADERS);
/// Records counters of zero.
void recordNoCounters(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results);

} // namespace voxtact
