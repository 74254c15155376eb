// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/try.h"
#include "core/method/method_table.h"
#include "device/detector/detector_impl.h"
#include "device/detector/many_poses.h"
#include "device/results/results_impl.h"
#include "voxtact/detector.h"
#include "vulkan/context_impl.h"
#include "vulkan/submit.h"

#include <algorithm>
#include <chrono>

namespace voxtact {

struct BlockingDetector::State {
    Detector detector;
    std::optional<Detector> forMany; ///< forManyPoses(), from the first such batch on
    bool noForMany = false;          ///< that one cannot be made; the other is as right
    ResultsDesc resultsDesc;
    std::optional<Results> results;
    Submitter submitter;

    /// The one to record a batch with.
    Result<const Detector*> detectorFor(const Batch& batch);
};

namespace {

constexpr std::uint32_t kFewestPairs = 64;

/// What a queue must be able to do for a method.
VkQueueFlags queueOf(CountingMethod method) {
    return rowOf(method).coverage == Coverage::Rasteriser ? VK_QUEUE_GRAPHICS_BIT : VK_QUEUE_COMPUTE_BIT;
}

std::uint64_t pairsOf(const Batch& batch) {
    std::uint64_t pairs = 0;
    for (const BatchItem& item : batch.items) {
        pairs += item.pairs();
    }
    return pairs;
}

/// What to make the Results with where those at hand have no room for a batch. What was large enough stays so.
std::optional<ResultsDesc> largerFor(const Batch& batch, const Outputs& outputs, const ResultsDesc& desc,
                                     const std::optional<Results>& results) {
    const std::uint64_t pairs = pairsOf(batch);
    const OutputRoom needed = roomFor(batch, outputs);
    if (results && results->maxPairs() >= pairs && desc.room.triangles >= needed.triangles &&
        desc.room.labels >= needed.labels) {
        return std::nullopt;
    }
    ResultsDesc wanted = desc;
    wanted.maxPairs = static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(pairs, results ? results->maxPairs() : kFewestPairs, UINT32_MAX));
    wanted.room.triangles = std::max(desc.room.triangles, needed.triangles);
    wanted.room.labels = std::max(desc.room.labels, needed.labels);
    return wanted;
}

std::vector<PairAnswer> unpackAll(std::span<const PairResult> results) {
    std::vector<PairAnswer> out;
    out.reserve(results.size());
    for (const PairResult& result : results) {
        out.push_back(unpack(result));
    }
    return out;
}

} // namespace

Result<const Detector*> BlockingDetector::State::detectorFor(const Batch& batch) {
    const std::optional<DetectorDesc> many =
        noForMany || hasDevicePoses(batch) ? std::nullopt : forManyPoses(detector.impl(), pairsOf(batch));
    if (!many) {
        return &detector;
    }
    if (!forMany) {
        Result<Detector> made = Detector::create(detector.impl().context, *many);
        if (!made.ok() && doesWithout(made.error())) {
            noForMany = true;
            return &detector;
        }
        VOXTACT_TRY(made);
        forMany = std::move(*made);
    }
    return &*forMany;
}

BlockingDetector::BlockingDetector(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
BlockingDetector::BlockingDetector(BlockingDetector&&) noexcept = default;
BlockingDetector& BlockingDetector::operator=(BlockingDetector&&) noexcept = default;
BlockingDetector::~BlockingDetector() = default;

Result<BlockingDetector> BlockingDetector::create(const Context& context, const DetectorDesc& desc,
                                                  const QueueAccess& queue, std::uint32_t maxContacts) {
    return guard([&]() -> Result<BlockingDetector> {
        Result<Detector> detector = Detector::create(context, desc);
        VOXTACT_TRY(detector);
        Result<Submitter> submitter = Submitter::create(context.impl(), queue, queueOf(detector->impl().desc.method));
        VOXTACT_TRY(submitter);
        const ResultsDesc resultsDesc{.timestamps = context.impl().timestampBits(queue.family) > 0,
                                      .queueFamily = queue.family,
                                      .room = {.triangles = 1, .labels = 1, .contacts = maxContacts},
                                      .staged = true}; // each submission is waited for
        return BlockingDetector(std::make_unique<State>(
            State{std::move(*detector), std::nullopt, false, resultsDesc, std::nullopt, std::move(*submitter)}));
    });
}

Result<BatchAnswer> BlockingDetector::detect(const Batch& batch) {
    return guard([&]() -> Result<BatchAnswer> {
        const auto start = std::chrono::steady_clock::now();
        State& s = live(state_);
        // First of all: a submission whose wait failed may still be using the Results.
        const Result<VkCommandBuffer> commandBuffer = s.submitter.begin();
        VOXTACT_TRY(commandBuffer);
        if (const std::optional<ResultsDesc> wanted =
                largerFor(batch, s.detector.impl().desc.outputs, s.resultsDesc, s.results)) {
            Result<Results> larger = stagedWhereThereIsRoom(
                *wanted, [&](const ResultsDesc& desc) { return Results::create(s.detector, desc); });
            VOXTACT_TRY(larger);
            s.results = std::move(*larger);
            s.resultsDesc = *wanted;
        }
        const Result<const Detector*> detector = s.detectorFor(batch);
        VOXTACT_TRY(detector);
        VOXTACT_TRY((*detector)->cmdDetect(*commandBuffer, batch, *s.results));
        VOXTACT_TRY(s.results->cmdReadBack(*commandBuffer));
        VOXTACT_TRY(s.submitter.submitAndWait());
        const Result<std::span<const PairResult>> results = s.results->read();
        VOXTACT_TRY(results);
        BatchAnswer answer;
        answer.pairs = unpackAll(*results);
        VOXTACT_TRY(s.results->readOutputs(answer));
        if (s.results->counted()) {
            const Result<CertifiedCounters> counters = s.results->counters();
            VOXTACT_TRY(counters);
            answer.counters = *counters;
        }
        if (s.resultsDesc.timestamps) {
            const Result<double> milliseconds = s.results->gpuMilliseconds();
            VOXTACT_TRY(milliseconds);
            answer.gpuMilliseconds = *milliseconds;
        }
        answer.wallMilliseconds =
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        return answer;
    });
}

const Detector& BlockingDetector::detector() const noexcept {
    return live(state_).detector;
}

} // namespace voxtact
