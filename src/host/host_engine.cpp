// SPDX-License-Identifier: MIT
#include "host/host_engine.h"

#include "core/base/enum_check.h"
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "core/geometry/projection.h"
#include "core/method/method_table.h"
#include "host/batch_check.h"
#include "host/outputs.h"

namespace voxtact::cpu {

namespace {

Result<void> checkCount(const Count& question) {
    VOXTACT_TRY(checkProjection(question.projection));
    VOXTACT_TRY(checkBoundary(question.boundary));
    VOXTACT_TRY(checkSamples(question.samplesPerVoxel));
    VOXTACT_TRY(checkFact(factOf("count", "resolution"), question.resolution));
    return checkOutputs(question);
}

Workshop workshopOf(HostEngineImpl& impl) {
    while (impl.scratches.size() < impl.workers.threads()) {
        impl.scratches.push_back(makeScratch());
    }
    return {impl.workers.pool(), impl.scratches};
}

} // namespace

Result<void> checkSteps(std::uint64_t maxSteps) {
    return maxSteps > 0 ? Result<void>() : refuse("at most 0 steps are allowed, a search takes at least one step");
}

HostEngine::HostEngine(std::unique_ptr<HostEngineImpl> impl) noexcept : impl_(std::move(impl)) {}
HostEngine::HostEngine(HostEngine&&) noexcept = default;
HostEngine& HostEngine::operator=(HostEngine&&) noexcept = default;
HostEngine::~HostEngine() = default;

Result<HostEngine> HostEngine::create(std::uint32_t threads) {
    return guard([&]() -> Result<HostEngine> {
        VOXTACT_TRY(checkThreads(threads));
        return HostEngine(std::make_unique<HostEngineImpl>(threads));
    });
}

std::uint32_t HostEngine::threads() const noexcept {
    return impl_->workers.threads();
}

Result<BatchAnswer> HostEngine::ask(const Count& question, const Batch& batch) {
    return guard([&]() -> Result<BatchAnswer> {
        const StopWatch watch;
        VOXTACT_TRY(checkCount(question));
        const Result<std::uint32_t> pairs = checkBatch(question, batch);
        VOXTACT_TRY(pairs);
        VOXTACT_TRY(checkLabelMaps(batch, question.outputs));
        const Cancellation cancel(batch.cancel);
        VOXTACT_TRY(checkNotCancelled(cancel));
        HostEngineImpl& impl = *impl_;
        BatchAnswer answer = rowOf(question.projection).certified
                                 ? runCertified(batch, cancel, *pairs, question, impl.workers.pool(), impl.certified)
                                 : runCounts(batch, cancel, *pairs, question, workshopOf(impl), impl.occupancies);
        VOXTACT_TRY(checkNotCancelled(cancel));
        answer.wallMilliseconds = watch.milliseconds();
        return answer;
    });
}

} // namespace voxtact::cpu
