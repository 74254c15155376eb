// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "device/results/results_impl.h"
#include "voxtact/detector.h"

#include <algorithm>

namespace voxtact {

namespace {

/// More frames than anybody has in flight.
constexpr std::uint32_t kMostFrames = 4096;

/// A slot would only know what the slots before it have left.
Result<void> checkInto(std::uint32_t frames, const ResultsDesc& desc) {
    const VkDeviceSize needed =
        (frames - 1) * resultBytes(desc.maxPairs) + VkDeviceSize{desc.maxPairs} * sizeof(PairResult);
    if (desc.into.buffer == VK_NULL_HANDLE || desc.into.size >= needed) {
        return {};
    }
    return refuse("ResultsDesc::into has " + std::to_string(desc.into.size) + " bytes, " + std::to_string(frames) +
                  " frames of " + std::to_string(desc.maxPairs) + " pairs need " + std::to_string(needed));
}

} // namespace

Result<ResultRing> ResultRing::create(const Detector& detector, std::uint32_t frames, const ResultsDesc& desc) {
    return guard([&]() -> Result<ResultRing> {
        if (frames == 0) {
            return refuse("a ring needs at least one frame");
        }
        if (frames > kMostFrames) {
            return refuse("a ring of " + std::to_string(frames) +
                          " frames is more than can be in flight: " + std::to_string(kMostFrames) + " at most");
        }
        VOXTACT_TRY(checkInto(frames, desc));
        ResultRing out;
        ResultsDesc slot = desc;
        for (std::uint32_t i = 0; i < frames; ++i) {
            Result<Results> results = Results::create(detector, slot);
            VOXTACT_TRY(results);
            out.slots_.push_back({std::move(*results)});
            const VkDeviceSize next = std::min(resultBytes(desc.maxPairs), slot.into.size);
            slot.into.offset += next;
            slot.into.size -= next;
        }
        return out;
    });
}

Result<Results*> ResultRing::begin(std::uint64_t frame) {
    return guard([&]() -> Result<Results*> {
        if (slots_.empty()) {
            return refuse("the ring was moved from: it has no frames");
        }
        Slot& slot = slots_[frame % slots_.size()];
        if (slot.used && frame < slot.frame) {
            return refuse("frame " + std::to_string(frame) + " comes after frame " + std::to_string(slot.frame) +
                          " in the same slot: frames ascend");
        }
        if (!slot.used || slot.frame != frame) {
            // What is still there is another frame's.
            ResultsImpl& results = slot.results.impl();
            results.detectRecorded = false;
            results.readBackRecorded = false;
        }
        slot.used = true;
        slot.frame = frame;
        return &slot.results;
    });
}

Result<Results*> ResultRing::results(std::uint64_t frame) {
    return guard([&]() -> Result<Results*> {
        if (slots_.empty()) {
            return refuse("the ring was moved from: it has no frames");
        }
        Slot& slot = slots_[frame % slots_.size()];
        if (!slot.used || slot.frame < frame) {
            return Error{ErrorCode::NotReady, 0, "frame " + std::to_string(frame) + " was never begun"};
        }
        if (slot.frame != frame) {
            return Error{ErrorCode::NotReady, 0,
                         "the slot of frame " + std::to_string(frame) + " was taken by frame " +
                             std::to_string(slot.frame) + ": a ring of " + std::to_string(slots_.size()) +
                             " keeps that many frames"};
        }
        return &slot.results;
    });
}

Result<std::span<const PairResult>> ResultRing::read(std::uint64_t frame) {
    const Result<Results*> of = results(frame);
    return of.ok() ? (*of)->read() : of.error();
}

Result<void> ResultRing::readOutputs(std::uint64_t frame, BatchAnswer& answer) {
    const Result<Results*> of = results(frame);
    return of.ok() ? (*of)->readOutputs(answer) : of.error();
}

} // namespace voxtact
