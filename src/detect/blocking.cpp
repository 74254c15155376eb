// SPDX-License-Identifier: MIT
#include "core/guard.h"
#include "detect/results_impl.h"
#include "gpu/context_impl.h"
#include "gpu/submit.h"
#include "voxtact/detector.h"

#include <algorithm>
#include <chrono>

namespace voxtact {

struct BlockingDetector::State {
    ContextImpl& context;
    Detector detector;
    Submitter submitter;
    ResultsDesc resultsDesc;
    std::optional<Results> results;
};

namespace {

constexpr std::uint32_t kFewestPairs = 64;

std::uint64_t pairsOf(const Batch& batch) {
    std::uint64_t pairs = 0;
    for (const BatchItem& item : batch.items) {
        pairs += item.world_from_object.size();
    }
    return pairs;
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

BlockingDetector::BlockingDetector(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
BlockingDetector::BlockingDetector(BlockingDetector&&) noexcept = default;
BlockingDetector& BlockingDetector::operator=(BlockingDetector&&) noexcept = default;
BlockingDetector::~BlockingDetector() = default;

Result<BlockingDetector> BlockingDetector::create(const Context& context, const DetectorDesc& desc,
                                                  const QueueAccess& queue) {
    return guard([&]() -> Result<BlockingDetector> {
        Result<Detector> detector = Detector::create(context, desc);
        if (!detector.ok()) {
            return detector.error();
        }
        Result<Submitter> submitter = Submitter::create(context.impl(), queue);
        if (!submitter.ok()) {
            return submitter.error();
        }
        ResultsDesc resultsDesc;
        resultsDesc.timestamps = context.impl().timestampBits(queue.family) > 0;
        resultsDesc.queueFamily = queue.family;
        return BlockingDetector(std::make_unique<State>(
            State{context.impl(), std::move(*detector), std::move(*submitter), resultsDesc, std::nullopt}));
    });
}

Result<BatchAnswer> BlockingDetector::detect(const Batch& batch) {
    return guard([&]() -> Result<BatchAnswer> {
        const auto start = std::chrono::steady_clock::now();
        State& s = *state_;
        const std::uint64_t pairs = pairsOf(batch);
        if (!s.results || s.results->maxPairs() < pairs) {
            s.resultsDesc.maxPairs =
                static_cast<std::uint32_t>(std::clamp<std::uint64_t>(pairs, kFewestPairs, UINT32_MAX));
            Result<Results> larger = Results::create(s.context, s.resultsDesc);
            if (!larger.ok()) {
                return larger.error();
            }
            s.results = std::move(*larger);
        }
        const Result<VkCommandBuffer> commandBuffer = s.submitter.begin();
        if (!commandBuffer.ok()) {
            return commandBuffer.error();
        }
        if (Result<void> recorded = s.detector.cmdDetect(*commandBuffer, batch, *s.results); !recorded.ok()) {
            return recorded.error();
        }
        if (Result<void> recorded = s.results->cmdReadBack(*commandBuffer); !recorded.ok()) {
            return recorded.error();
        }
        if (Result<void> done = s.submitter.submitAndWait(); !done.ok()) {
            return done.error();
        }
        const Result<std::span<const PairResult>> results = s.results->read();
        if (!results.ok()) {
            return results.error();
        }
        BatchAnswer answer;
        answer.pairs = unpackAll(*results);
        if (const Result<double> milliseconds = s.results->gpuMilliseconds(); milliseconds.ok()) {
            answer.gpuMilliseconds = *milliseconds;
        }
        answer.wallMilliseconds =
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        return answer;
    });
}

const Detector& BlockingDetector::detector() const noexcept {
    return state_->detector;
}

} // namespace voxtact
