// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "device/detector/detector_impl.h"
#include "device/results/result_store.h"
#include "device/touch/certified_queues.h"
#include "exact/shared.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/timestamps.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

namespace voxtact {

namespace {

/// Number of the copy that the host has; 0: none.
std::uint32_t copyOnHost(const ResultsImpl& results) {
    auto* at = static_cast<std::byte*>(results.readBack.mapped) + results.copyNumberOnHost();
    return std::atomic_ref(*reinterpret_cast<std::uint32_t*>(at)).load(std::memory_order_acquire);
}

Error notReady(const char* text) {
    return {ErrorCode::NotReady, 0, text};
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

Result<Results> Results::create(const Detector& detector, const ResultsDesc& desc) {
    return guard([&]() -> Result<Results> {
        const DetectorImpl& of = detector.impl();
        VOXTACT_TRY(of.context.alive());
        Result<std::unique_ptr<ResultsImpl>> impl = makeResults(of.context, of.desc, desc);
        VOXTACT_TRY(impl);
        return Results(std::move(*impl));
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

bool Results::counted() const noexcept {
    return live(impl_).counted;
}

Result<CertifiedCounters> Results::counters() {
    return guard([&]() -> Result<CertifiedCounters> {
        const ResultsImpl& r = live(impl_);
        VOXTACT_TRY(checkReadable(r));
        if (!r.counted) {
            return notReady("the last cmdDetect() was of a detector without CertifiedDesc::counters");
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
        const auto elapsed = static_cast<double>(ticksBetween(ticks[0], ticks[1], r.timestampBits).value_or(0));
        return elapsed * static_cast<double>(r.context.limits.timestampPeriod) * 1e-6;
    });
}

} // namespace voxtact
