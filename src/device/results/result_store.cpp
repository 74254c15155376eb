// SPDX-License-Identifier: MIT
#include "device/results/result_store.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/method/method_table.h"
#include "device/detector/pair_setup.h"
#include "device/detector/recording.h"
#include "device/touch/certified_queues.h"
#include "vulkan/query_pool.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace voxtact {

namespace {

RoomLimits limitsOf(const ContextImpl& context) {
    return roomLimits(context.limits, context.maxAllocation, context.memory);
}

VkDeviceSize bytesFor(const ContextImpl& context) {
    return limitsOf(context).bytes;
}

/// For any projection, as far as the device has room for them, and for the least queues in addition to them.
std::uint32_t transformsFor(const ContextImpl& context, std::uint32_t maxPairs) {
    const VkDeviceSize bytes =
        bytesFor(context) - std::min(bytesFor(context), kSetupBytes + kOpaqueBytes + queueBytes(kUsualQueueRoom));
    const VkDeviceSize room = std::min<VkDeviceSize>(bytes / sizeof(shader::PairTransform), UINT32_MAX);
    return static_cast<std::uint32_t>(std::max<VkDeviceSize>(
        std::min<VkDeviceSize>(VkDeviceSize{kMostTransformsPerPair} * maxPairs, room), maxPairs));
}

Result<void> checkInto(const ContextImpl& context, const ResultsDesc& desc) {
    if (desc.into.buffer == VK_NULL_HANDLE) {
        return desc.into.offset == 0 && desc.into.size == 0
                   ? Result<void>()
                   : refuse("ResultsDesc::into has an offset or a size, but no buffer");
    }
    if (desc.into.size == VK_WHOLE_SIZE) {
        return refuse("ResultsDesc::into has the size VK_WHOLE_SIZE; it must be said in bytes");
    }
    // Results of 64-bit queries begin at multiples of 8.
    const VkDeviceSize alignment = std::max<VkDeviceSize>(context.limits.minStorageBufferOffsetAlignment, 8);
    if (desc.into.offset % alignment != 0) {
        return refuse("ResultsDesc::into begins at byte " + std::to_string(desc.into.offset) +
                      "; on this device that must be a multiple of " + std::to_string(alignment));
    }
    if (const VkDeviceSize needed = VkDeviceSize{desc.maxPairs} * sizeof(PairResult); desc.into.size < needed) {
        return refuse("ResultsDesc::into has " + std::to_string(desc.into.size) + " bytes, " +
                      std::to_string(desc.maxPairs) + " pairs need " + std::to_string(needed));
    }
    if (desc.into.offset > std::numeric_limits<VkDeviceSize>::max() - desc.into.size) {
        return refuse("ResultsDesc::into of " + std::to_string(desc.into.size) + " bytes cannot begin at byte " +
                      std::to_string(desc.into.offset));
    }
    return {};
}

Result<void> checkDesc(const ContextImpl& context, const ResultsDesc& desc) {
    if (desc.maxPairs == 0) {
        return refuse("ResultsDesc::maxPairs is 0");
    }
    if (const std::uint32_t clusters = desc.clustersAtOnce;
        clusters != 0 && (clusters < kLeastQueueRoom || clusters > kMostQueueRoom)) {
        return refuse("ResultsDesc::clustersAtOnce is " + std::to_string(clusters) + "; 0, or " +
                      std::to_string(kLeastQueueRoom) + " to " + std::to_string(kMostQueueRoom) + ", is possible");
    }
    const std::uint64_t bytes =
        std::uint64_t{desc.maxPairs} * sizeof(shader::PairTransform) + kSetupBytes + kOpaqueBytes;
    if (bytes > context.limits.maxStorageBufferRange) {
        return Error{ErrorCode::LimitExceeded, 0,
                     std::to_string(desc.maxPairs) + " pairs need a buffer of " + std::to_string(bytes) +
                         " bytes, the device's maxStorageBufferRange is " +
                         std::to_string(context.limits.maxStorageBufferRange)};
    }
    VOXTACT_TRY(checkInto(context, desc));
    if (desc.timestamps) {
        constexpr VkQueueFlags kAny = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        VOXTACT_TRY(context.checkFamily(desc.queueFamily, kAny, "ResultsDesc::queueFamily"));
    }
    if (desc.timestamps && context.timestampBits(desc.queueFamily) == 0) {
        return Error{ErrorCode::Unsupported, 0,
                     "queue family " + std::to_string(desc.queueFamily) + " has no timestamps"};
    }
    return {};
}

Result<void> makeQueueRoom(const ContextImpl& context, const ResultsDesc& desc, ResultsImpl& results) {
    results.queueRoom = queueRoomFor(desc, limitsOf(context), firstQueueByte(results));
    if (results.queueRoom != 0) {
        return {};
    }
    const VkDeviceSize bytes = firstQueueByte(results) + queueBytes(kLeastQueueRoom);
    const bool ofBuffer = bytesFor(context) == context.limits.maxStorageBufferRange;
    return Error{ErrorCode::LimitExceeded, 0,
                 std::to_string(desc.maxPairs) +
                     " pairs with the queues of the projection certified need a buffer of " + std::to_string(bytes) +
                     " bytes or more, the device's " +
                     (ofBuffer ? "maxStorageBufferRange" : "maxMemoryAllocationSize") + " is " +
                     std::to_string(bytesFor(context))};
}

VkDeviceSize transformBytes(const ResultsImpl& results) {
    return firstQueueByte(results) + (results.queueRoom == 0 ? 0 : queueBytes(results.queueRoom));
}

/// The buffers of a Results, each with what it is for.
Result<void> makeBuffers(ResultsImpl& out, const ResultsDesc& desc) {
    const VkDeviceSize bytes = VkDeviceSize{out.maxPairs} * sizeof(PairResult);
    const bool ownResults = desc.into.buffer == VK_NULL_HANDLE;
    struct Wanted {
        bool wanted;
        Buffer& buffer;
        VkDeviceSize size;
        VkBufferUsageFlags usage;
        MemoryUse use;
        const char* name;
    };
    constexpr VkBufferUsageFlags kTo = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const Wanted wanted[] = {
        {true, out.transforms, transformBytes(out),
         kTo | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Device,
         "pair transforms"},
        {ownResults, out.ownResults, bytes, kTo | VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Device, "pair results"},
        {desc.readBack, out.readBack, out.readBackBytes(), VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::ReadBack,
         "pair results on the host"},
        {desc.staged, out.staging,
         VkDeviceSize{out.maxPairs} * kMostTransformsPerPair * sizeof(shader::PairTransform) + bytes,
         VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::Upload, "staged pairs"},
    };
    for (const Wanted& each : wanted) {
        if (!each.wanted) {
            continue;
        }
        Result<Buffer> made = makeBuffer(out.context, each.size, each.usage, each.use, each.name);
        VOXTACT_TRY(made);
        each.buffer = std::move(*made);
    }
    out.results = {ownResults ? out.ownResults.get() : desc.into.buffer, desc.into.offset, bytes};
    if (!desc.readBack) {
        return {};
    }
    std::memset(static_cast<std::byte*>(out.readBack.mapped) + out.copyNumberOnHost(), 0, sizeof out.copies);
    return flush(out.context, out.readBack);
}

Result<void> makeQueries(ResultsImpl& out) {
    Result<Owned<VkQueryPool>> occlusion =
        makeQueryPool(out.context, VK_QUERY_TYPE_OCCLUSION, out.maxPairs, "occlusion queries");
    VOXTACT_TRY(occlusion);
    out.occlusion = std::move(*occlusion);
    if (out.timestampBits > 0) {
        Result<Owned<VkQueryPool>> timestamps =
            makeQueryPool(out.context, VK_QUERY_TYPE_TIMESTAMP, 2, "batch timestamps");
        VOXTACT_TRY(timestamps);
        out.timestamps = std::move(*timestamps);
    }
    return {};
}

Result<void> makeDescriptors(ResultsImpl& out) {
    ContextImpl& context = out.context;
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
    Result<DescriptorSet> set = makeDescriptorSet(context, context.setLayouts[VOXTACT_SET_PAIRS], {&size, 1}, "pairs");
    VOXTACT_TRY(set);
    out.descriptors = std::move(*set);
    writeBuffer(context, out.descriptors.set, VOXTACT_BINDING_TRANSFORMS, out.transforms.get());
    writeBuffer(context, out.descriptors.set, VOXTACT_BINDING_RESULTS, out.results.buffer, out.results.size,
                out.results.offset);
    return {};
}

} // namespace

Result<std::unique_ptr<ResultsImpl>> makeResults(ContextImpl& context, const PassDesc& detector,
                                                 const ResultsDesc& desc) {
    VOXTACT_TRY(checkDesc(context, desc));
    auto impl = std::make_unique<ResultsImpl>(ResultsImpl{.context = context,
                                                          .certified = rowOf(detector.projection).certified,
                                                          .outputBits = outputsConstant(detector.outputs),
                                                          .maxPairs = desc.maxPairs});
    impl->maxTransforms = transformsFor(context, desc.maxPairs);
    VOXTACT_TRY(impl->certified ? makeQueueRoom(context, desc, *impl) : Result<void>());
    impl->timestampBits = desc.timestamps ? context.timestampBits(desc.queueFamily) : 0;
    VOXTACT_TRY(makeBuffers(*impl, desc));
    for (const auto make : {makeQueries, makeDescriptors, makeSetupSets}) {
        VOXTACT_TRY(make(*impl));
    }
    if (detector.outputs.any()) {
        Result<std::unique_ptr<OutputStore>> outputs =
            makeOutputStore(context, desc, detector.outputs, impl->transforms.get(), impl->results);
        VOXTACT_TRY(outputs);
        impl->outputs = std::move(*outputs);
    }
    return impl;
}

} // namespace voxtact
