// SPDX-License-Identifier: MIT
#include "device/touch/certified_queues.h"
#include "vulkan/barriers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

namespace voxtact {

VkDeviceSize setupByte(const ResultsImpl& results) noexcept {
    return atPart(VkDeviceSize{results.maxTransforms} * sizeof(shader::PairTransform));
}

VkDeviceSize opaqueByte(const ResultsImpl& results) noexcept {
    return setupByte(results) + kSetupBytes;
}

VkDeviceSize firstQueueByte(const ResultsImpl& results) noexcept {
    return opaqueByte(results) + kOpaqueBytes;
}

std::uint32_t firstQueueWord(const ResultsImpl& results) noexcept {
    return static_cast<std::uint32_t>(firstQueueByte(results) / sizeof(std::uint32_t));
}

VkDeviceSize countersByte(const ResultsImpl& results) noexcept {
    return firstQueueByte(results) + VOXTACT_WORD_COUNTERS * sizeof(std::uint32_t);
}

RoomLimits roomLimits(const VkPhysicalDeviceLimits& device, VkDeviceSize maxAllocation,
                      const VkPhysicalDeviceMemoryProperties& memory) noexcept {
    constexpr VkDeviceSize kShareOfMemory = 128;
    constexpr std::uint32_t kLeastWorkGroups = 65535;
    VkDeviceSize largest = 0;
    for (const VkMemoryHeap& heap : std::span(memory.memoryHeaps).first(memory.memoryHeapCount)) {
        largest = (heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0 ? std::max(largest, heap.size) : largest;
    }
    const std::uint32_t times =
        std::clamp(device.maxComputeWorkGroupCount[0] / kLeastWorkGroups, 1U, kMostQueueRoom / kMostRoomAnywhere);
    return {std::min<VkDeviceSize>(device.maxStorageBufferRange, maxAllocation), largest / kShareOfMemory,
            kMostRoomAnywhere * std::bit_floor(times)};
}

std::uint32_t queueRoomFor(const ResultsDesc& desc, const RoomLimits& limits, VkDeviceSize first) noexcept {
    constexpr std::uint32_t kClustersOfPair = 64;
    constexpr std::uint32_t kStep = 16; // src/exact/shared.h
    std::uint32_t room = std::min(desc.clustersAtOnce, limits.room);
    if (room == 0) {
        const std::uint32_t pairs = std::bit_ceil(std::min(desc.maxPairs, limits.room / kClustersOfPair));
        room = std::max(kUsualQueueRoom, pairs * kClustersOfPair);
        while (room > kMostRoomAnywhere && queueBytes(room) > limits.usualBytes) {
            room /= 2;
        }
    }
    while (room > kLeastQueueRoom && first + queueBytes(room) > limits.bytes) {
        room = std::max(room / 2, kLeastQueueRoom);
    }
    const bool fits = room >= kLeastQueueRoom && first + queueBytes(room) <= limits.bytes;
    return fits ? room / kStep * kStep : 0;
}

void recordQueueHeaders(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results,
                        std::uint32_t rounds) {
    std::array<std::uint32_t, VOXTACT_HEADERS * VOXTACT_HEADER_WORDS> words{};
    for (std::size_t round = 0; round < VOXTACT_HEADERS; ++round) {
        for (std::size_t queue = 0; queue < VOXTACT_QUEUES; ++queue) {
            const std::size_t command = round * VOXTACT_HEADER_WORDS + 4 * queue;
            words[command + 1] = 1;
            words[command + 2] = 1;
        }
        const std::size_t left = round * VOXTACT_HEADER_WORDS + std::size_t{4} * VOXTACT_QUEUE_LEFT;
        words[left] = VOXTACT_LEFT_COLUMNS;
        words[left + 1] = VOXTACT_LEFT_ROWS;
        words[left + 2] = 0;
    }
    cmdUpdateBuffer(
        context, commandBuffer, results.transforms.get(), firstQueueByte(results),
        std::as_bytes(std::span(words).first(std::min<std::uint32_t>(rounds, VOXTACT_HEADERS) * VOXTACT_HEADER_WORDS)));
}

void recordNoCounters(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results) {
    context.vk.CmdFillBuffer(commandBuffer, results.transforms.get(), countersByte(results), sizeof(CertifiedCounters),
                             0);
}

} // namespace voxtact
