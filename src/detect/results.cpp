// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/geometry/closest_gradient.h"
#include "detect/certified_queues.h"
#include "detect/pair_setup.h"
#include "detect/recording.h"
#include "detect/results_impl.h"
#include "gpu/barriers.h"
#include "gpu/debug.h"
#include "shared.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

namespace voxtact {

namespace {

Result<Owned<VkQueryPool>> makeQueryPool(ContextImpl& context, VkQueryType type, std::uint32_t count,
                                         const char* name) {
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = type;
    info.queryCount = count;
    VkQueryPool handle = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateQueryPool(context.device, &info, context.allocator, &handle);
        result != VK_SUCCESS) {
        return context.failure(result, "making a query pool");
    }
    nameObject(context, VK_OBJECT_TYPE_QUERY_POOL, handle, name);
    return Owned<VkQueryPool>(
        context, handle, [](ContextImpl& c, VkQueryPool pool) { c.vk.DestroyQueryPool(c.device, pool, c.allocator); });
}

VkDeviceSize bytesFor(const ContextImpl& context) {
    return std::min<VkDeviceSize>(context.limits.maxStorageBufferRange, context.maxAllocation);
}

/// For any projection, as far as the device has room for them, and for the least queues beside them.
std::uint32_t transformsFor(const ContextImpl& context, std::uint32_t maxPairs) {
    const VkDeviceSize bytes =
        bytesFor(context) - std::min(bytesFor(context), kSetupBytes + queueBytes(kUsualQueueRoom));
    const VkDeviceSize room = std::min<VkDeviceSize>(bytes / sizeof(shader::PairTransform), UINT32_MAX);
    return static_cast<std::uint32_t>(std::max<VkDeviceSize>(
        std::min<VkDeviceSize>(VkDeviceSize{kMostTransformsPerPair} * maxPairs, room), maxPairs));
}

Result<void> checkInto(const ContextImpl& context, const ResultsDesc& desc) {
    if (desc.into.buffer == VK_NULL_HANDLE) {
        return {};
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
    return {};
}

Result<void> checkLabelRoom(const ContextImpl& context, const ResultsDesc& desc) {
    if (desc.labelClearances == 0) {
        return {};
    }
    if (!desc.clearances) {
        return refuse("ResultsDesc::labelClearances is about clearances, and ResultsDesc::clearances is false");
    }
    if (desc.labelClearances > kMostMeasuredLabels) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "ResultsDesc::labelClearances is " + std::to_string(desc.labelClearances) +
                         ", one batch measures at most " + std::to_string(kMostMeasuredLabels) + " labels"};
    }
    if (const VkDeviceSize bytes = labelBytes(desc.maxPairs, desc.labelClearances);
        bytes > context.limits.maxStorageBufferRange) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the clearances of " + std::to_string(desc.maxPairs) + " pairs to " +
                         std::to_string(desc.labelClearances) + " labels need " + std::to_string(bytes) +
                         " bytes, the device's maxStorageBufferRange is " +
                         std::to_string(context.limits.maxStorageBufferRange)};
    }
    return {};
}

Result<void> checkDesc(const ContextImpl& context, const ResultsDesc& desc) {
    if (desc.maxPairs == 0) {
        return refuse("ResultsDesc::maxPairs is 0");
    }
    if (const std::uint32_t clusters = desc.clustersAtOnce.value_or(0);
        clusters != 0 && (clusters < kLeastQueueRoom || clusters > kMostQueueRoom)) {
        return refuse("ResultsDesc::clustersAtOnce is " + std::to_string(clusters) + "; 0, or " +
                      std::to_string(kLeastQueueRoom) + " to " + std::to_string(kMostQueueRoom) + ", is possible");
    }
    const std::uint64_t bytes = std::uint64_t{desc.maxPairs} * sizeof(shader::PairTransform) + kSetupBytes;
    if (bytes > context.limits.maxStorageBufferRange) {
        return Error{ErrorCode::LimitExceeded, 0,
                     std::to_string(desc.maxPairs) + " pairs need a buffer of " + std::to_string(bytes) +
                         " bytes, the device's maxStorageBufferRange is " +
                         std::to_string(context.limits.maxStorageBufferRange)};
    }
    if (desc.closest && !desc.clearances) {
        return refuse("ResultsDesc::closest is about clearances, and ResultsDesc::clearances is false");
    }
    VOXTACT_TRY(checkLabelRoom(context, desc));
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

VkDeviceSize transformBytes(const ResultsImpl& results) {
    const std::uint32_t room = results.queueRoom;
    return firstQueueByte(results) + (room == 0 ? 0 : queueBytes(room)) +
           (results.clearances ? clearanceBytes(room, results.maxPairs) : 0) +
           (results.closest ? closestBytes(results.maxPairs) : 0) + labelBytes(results.maxPairs, results.labelRoom);
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

/// Number of the copy that the host has; 0: none.
std::uint32_t copyOnHost(const ResultsImpl& results) {
    auto* at = static_cast<std::byte*>(results.readBack.mapped) + results.copyNumberOnHost();
    return std::atomic_ref(*reinterpret_cast<std::uint32_t*>(at)).load(std::memory_order_acquire);
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

Error notReady(const char* text) {
    return {ErrorCode::NotReady, 0, text};
}

/// A PairClearance or a LabelClearance.
template <class Clearance> Clearance unpack(const PairResult& pair, const ClearanceResult& found, double maximum) {
    Clearance out;
    out.pair = pair.pair;
    out.item = pair.item;
    out.pose = pair.pose;
    out.bounds = {static_cast<double>(found.lo), static_cast<double>(found.hi)};
    out.end = static_cast<ClearanceEnd>(found.end);
    if (out.end == ClearanceEnd::Beyond) {
        out.bounds.lo = maximum; // a float is not less
    }
    return out;
}

ClosestPoints unpack(const ClosestResult& found) {
    const Vec3 way{static_cast<double>(found.wayX), static_cast<double>(found.wayY), static_cast<double>(found.wayZ)};
    const Vec3 arm{static_cast<double>(found.armX), static_cast<double>(found.armY), static_cast<double>(found.armZ)};
    ClosestPoints out;
    out.triangle = found.triangle;
    out.mesh = {static_cast<double>(found.x), static_cast<double>(found.y), static_cast<double>(found.z)};
    out.volume = step(out.mesh, way, 1);
    setGradient(out, way, arm);
    return out;
}

/// Element `i` of what is behind so many bytes of the host's copy.
template <class Element> Element copied(const ResultsImpl& results, VkDeviceSize first, std::uint32_t i) {
    Element element{};
    std::memcpy(&element, static_cast<const std::byte*>(results.readBack.mapped) + first + i * sizeof element,
                sizeof element);
    return element;
}

Result<void> checkReadable(const ResultsImpl& results) {
    VOXTACT_TRY(results.context.alive());
    if (!results.readBackRecorded) {
        return notReady("cmdReadBack() was not recorded after the last cmdDetect()");
    }
    if (results.pairs == 0) {
        return {};
    }
    VOXTACT_TRY(invalidate(results.context, results.readBack));
    if (copyOnHost(results) != results.copies) {
        return notReady("the submission with the last cmdReadBack() has not completed");
    }
    return {};
}

} // namespace

Results::Results(std::unique_ptr<ResultsImpl> impl) noexcept : impl_(std::move(impl)) {}
Results::Results(Results&&) noexcept = default;
Results& Results::operator=(Results&&) noexcept = default;
Results::~Results() = default;

Result<Results> Results::create(const Context& context, const ResultsDesc& desc) {
    return create(context.impl(), desc);
}

Result<Results> Results::create(ContextImpl& c, const ResultsDesc& desc) {
    return guard([&]() -> Result<Results> {
        VOXTACT_TRY(c.alive());
        VOXTACT_TRY(checkDesc(c, desc));
        auto impl = std::make_unique<ResultsImpl>(ResultsImpl{.context = c, .maxPairs = desc.maxPairs});
        impl->maxTransforms = transformsFor(c, desc.maxPairs);
        impl->queueRoom = queueRoomFor(desc, bytesFor(c), firstQueueByte(*impl));
        impl->clearances = desc.clearances && impl->queueRoom > 0;
        impl->closest = desc.closest && impl->clearances;
        impl->labelRoom = impl->clearances ? desc.labelClearances : 0;
        impl->timestampBits = desc.timestamps ? c.timestampBits(desc.queueFamily) : 0;
        VOXTACT_TRY(makeBuffers(*impl, desc));
        for (const auto make : {makeQueries, makeDescriptors, makeSetupSet}) {
            VOXTACT_TRY(make(*impl));
        }
        if (desc.room) {
            Result<std::unique_ptr<OutputStore>> outputs =
                makeOutputStore(c, desc, impl->transforms.get(), impl->results);
            VOXTACT_TRY(outputs);
            impl->outputs = std::move(*outputs);
        }
        return Results(std::move(impl));
    });
}

std::uint32_t Results::maxPairs() const noexcept {
    return live(impl_).maxPairs;
}

std::uint32_t Results::pairs() const noexcept {
    return live(impl_).pairs;
}

BufferRange Results::pairResults() const noexcept {
    return live(impl_).results;
}

VkBuffer Results::buffer() const noexcept {
    return live(impl_).results.buffer;
}

BufferRange Results::clearances() const noexcept {
    const ResultsImpl& r = live(impl_);
    if (!r.clearances) {
        return {};
    }
    return {r.transforms.get(), clearancesByte(r), VkDeviceSize{r.maxPairs} * sizeof(ClearanceResult)};
}

BufferRange Results::closest() const noexcept {
    const ResultsImpl& r = live(impl_);
    if (!r.closest) {
        return {};
    }
    return {r.transforms.get(), closestByte(r), VkDeviceSize{r.maxPairs} * sizeof(ClosestResult)};
}

BufferRange Results::labelClearances() const noexcept {
    const ResultsImpl& r = live(impl_);
    if (r.labelRoom == 0) {
        return {};
    }
    return {r.transforms.get(), labelClearancesByte(r),
            VkDeviceSize{r.maxPairs} * r.labelRoom * sizeof(ClearanceResult)};
}

Result<void> Results::cmdReadBack(VkCommandBuffer commandBuffer) {
    return guard([&]() -> Result<void> {
        ResultsImpl& r = live(impl_);
        if (!r.readBack.buffer) {
            return refuse("the Results were made without readBack");
        }
        VOXTACT_TRY(r.context.recordable(commandBuffer));
        if (!r.detectRecorded) {
            return notReady("there is nothing to read back: cmdDetect() was not recorded");
        }
        r.readBackRecorded = true;
        if (r.pairs == 0) {
            return {};
        }
        r.copies = r.copies == UINT32_MAX ? 1 : r.copies + 1;
        const Label label(r.context, commandBuffer, "voxtact read back");
        // An earlier copy into the same memory must be done first.
        barrier(r.context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
        const VkBufferCopy region{r.results.offset, 0, VkDeviceSize{r.pairs} * sizeof(PairResult)};
        r.context.vk.CmdCopyBuffer(commandBuffer, r.results.buffer, r.readBack.get(), 1, &region);
        if (r.counted) {
            const VkBufferCopy counters{countersByte(r), r.countersOnHost(), sizeof(CertifiedCounters)};
            r.context.vk.CmdCopyBuffer(commandBuffer, r.transforms.get(), r.readBack.get(), 1, &counters);
        }
        if (r.maximum) {
            const VkBufferCopy clearances{clearancesByte(r), r.clearancesOnHost(),
                                          VkDeviceSize{r.pairs} * sizeof(ClearanceResult)};
            r.context.vk.CmdCopyBuffer(commandBuffer, r.transforms.get(), r.readBack.get(), 1, &clearances);
        }
        if (r.pointed) {
            const VkBufferCopy closest{closestByte(r), r.closestOnHost(),
                                       VkDeviceSize{r.pairs} * sizeof(ClosestResult)};
            r.context.vk.CmdCopyBuffer(commandBuffer, r.transforms.get(), r.readBack.get(), 1, &closest);
        }
        if (r.labels && !r.labels->empty()) {
            const VkBufferCopy labels{labelClearancesByte(r), r.labelsOnHost(),
                                      VkDeviceSize{r.pairs} * r.labels->size() * sizeof(ClearanceResult)};
            r.context.vk.CmdCopyBuffer(commandBuffer, r.transforms.get(), r.readBack.get(), 1, &labels);
        }
        if (r.outputs) {
            copyOutputs(r.context, commandBuffer, *r.outputs);
        }
        // The number comes after everything that it speaks for.
        barrier(r.context, commandBuffer, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
                VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_READ_BIT);
        r.context.vk.CmdFillBuffer(commandBuffer, r.readBack.get(), r.copyNumberOnHost(), sizeof r.copies, r.copies);
        barrier(r.context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
        return {};
    });
}

Result<std::span<const PairResult>> Results::read() {
    return guard([&]() -> Result<std::span<const PairResult>> {
        const ResultsImpl& r = live(impl_);
        VOXTACT_TRY(checkReadable(r));
        return std::span(static_cast<const PairResult*>(r.readBack.mapped), r.pairs);
    });
}

Result<void> Results::readOutputs(BatchAnswer& answer) {
    return guard([&]() -> Result<void> {
        const ResultsImpl& r = live(impl_);
        VOXTACT_TRY(checkReadable(r));
        clearOutputs(answer);
        if (r.outputs == nullptr || r.pairs == 0) {
            return {};
        }
        VOXTACT_TRY(invalidate(r.context, r.outputs->readBack));
        return unpackOutputs(*r.outputs, answer);
    });
}

bool Results::measured() const noexcept {
    return live(impl_).maximum.has_value();
}

Result<std::vector<PairClearance>> Results::readClearances() {
    return guard([&]() -> Result<std::vector<PairClearance>> {
        const ResultsImpl& r = live(impl_);
        VOXTACT_TRY(checkReadable(r));
        if (!r.maximum) {
            return notReady("the last cmdDetect() was of a detector without DetectorDesc::clearance");
        }
        const auto* pairs = static_cast<const PairResult*>(r.readBack.mapped);
        std::vector<PairClearance> out;
        out.reserve(r.pairs);
        for (std::uint32_t i = 0; i < r.pairs; ++i) {
            out.push_back(
                unpack<PairClearance>(pairs[i], copied<ClearanceResult>(r, r.clearancesOnHost(), i), *r.maximum));
            if (!r.pointed) {
                continue;
            }
            if (const auto closest = copied<ClosestResult>(r, r.closestOnHost(), i); closest.some != 0) {
                out.back().closest = unpack(closest);
            }
        }
        return out;
    });
}

bool Results::measuredLabels() const noexcept {
    return live(impl_).labels.has_value();
}

Result<std::vector<LabelClearance>> Results::readLabelClearances() {
    return guard([&]() -> Result<std::vector<LabelClearance>> {
        const ResultsImpl& r = live(impl_);
        VOXTACT_TRY(checkReadable(r));
        if (!r.labels) {
            return notReady("the last cmdDetect() was of a detector without DetectorDesc::labelClearances");
        }
        const auto* pairs = static_cast<const PairResult*>(r.readBack.mapped);
        std::vector<LabelClearance> out;
        out.reserve(r.pairs * r.labels->size());
        for (std::uint32_t i = 0; i < r.pairs; ++i) {
            for (const std::int32_t label : *r.labels) {
                const auto number = static_cast<std::uint32_t>(out.size());
                out.push_back(
                    unpack<LabelClearance>(pairs[i], copied<ClearanceResult>(r, r.labelsOnHost(), number), *r.maximum));
                out.back().label = label;
            }
        }
        return out;
    });
}

bool Results::counted() const noexcept {
    return live(impl_).counted;
}

Result<CertifiedCounters> Results::counters() {
    return guard([&]() -> Result<CertifiedCounters> {
        const ResultsImpl& r = live(impl_);
        VOXTACT_TRY(checkReadable(r));
        if (!r.counted) {
            return notReady("the last cmdDetect() was of a detector without DetectorDesc::counters");
        }
        CertifiedCounters counters{};
        if (r.pairs > 0) {
            std::memcpy(&counters, static_cast<const std::byte*>(r.readBack.mapped) + r.countersOnHost(),
                        sizeof counters);
        }
        return counters;
    });
}

Result<double> Results::gpuMilliseconds() {
    return guard([&]() -> Result<double> {
        const ResultsImpl& r = live(impl_);
        VOXTACT_TRY(r.context.alive());
        if (!r.timestamps) {
            return notReady("the Results were made without timestamps");
        }
        if (!r.detectRecorded) {
            return notReady("cmdDetect() was not recorded");
        }
        if (r.pairs == 0) {
            return 0.0;
        }
        std::array<std::uint64_t, 2> ticks{};
        const VkResult result =
            r.context.vk.GetQueryPoolResults(r.context.device, r.timestamps.get(), 0, 2, sizeof ticks, ticks.data(),
                                             sizeof ticks[0], VK_QUERY_RESULT_64_BIT);
        if (result == VK_NOT_READY) {
            return notReady("the submission has not completed");
        }
        if (result != VK_SUCCESS) {
            return r.context.failure(result, "reading timestamps");
        }
        // The counter has fewer than 64 bits on some queues and wraps.
        const std::uint64_t mask =
            r.timestampBits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << r.timestampBits) - 1;
        const auto elapsed = static_cast<double>((ticks[1] - ticks[0]) & mask);
        return elapsed * static_cast<double>(r.context.limits.timestampPeriod) * 1e-6;
    });
}

} // namespace voxtact
