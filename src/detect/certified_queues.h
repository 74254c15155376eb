// SPDX-License-Identifier: MIT
#pragma once

#include "detect/results_impl.h"
#include "shared.h"

namespace voxtact {

/// Clusters of pairs that one round of the projection conservative has at most. Its queues have room for them, for 32
/// cells for each of them, and so on: shaders/shared.h.
inline constexpr std::uint32_t kLeastQueueRoom = 2048;
inline constexpr std::uint32_t kMostQueueRoom = 16384;

[[nodiscard]] constexpr VkDeviceSize queueBytes(std::uint32_t room) noexcept {
    return VkDeviceSize{VOXTACT_QUEUE_WORDS(room)} * sizeof(std::uint32_t);
}

/// Where the queues begin in the buffer of the transforms.
[[nodiscard]] VkDeviceSize firstQueueByte(const ResultsImpl& results) noexcept;

/// The room of Results for so many pairs, in a buffer of at most `bytes`, of which the queues begin at `first`; 0 where
/// it has none for them.
[[nodiscard]] std::uint32_t queueRoomFor(std::uint32_t maxPairs, VkDeviceSize bytes, VkDeviceSize first) noexcept;

/// Records the headers of VOXTACT_HEADERS rounds: commands of no work groups, empty queues.
void recordQueueHeaders(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results);

} // namespace voxtact
