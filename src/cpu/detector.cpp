// SPDX-License-Identifier: MIT
#include "core/base/enum_check.h"
#include "core/base/guard.h"
#include "core/base/try.h"
#include "core/geometry/projection.h"
#include "core/method/certified_constants.h"
#include "core/method/method_table.h"
#include "cpu/batch_check.h"
#include "cpu/cancel.h"
#include "cpu/certified/certified_run.h"
#include "cpu/outputs.h"
#include "cpu/raster/count_run.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace voxtact::cpu {

struct DetectorImpl {
    explicit DetectorImpl(const DetectorDesc& chosen, std::uint32_t threads) : desc(chosen), pool(threads) {
        for (std::uint32_t thread = 0; thread < pool.threads(); ++thread) {
            scratches.push_back(makeScratch());
        }
    }

    DetectorDesc desc;
    ThreadPool pool;
    std::vector<ScratchPointer> scratches;
    Occupancies occupancies;
    CertifiedOccupancies certified;
};

namespace {

Result<void> checkDesc(const DetectorDesc& desc) {
    for (const Result<void>& known : {checkProjection(desc.projection), checkBoundary(desc.boundary)}) {
        if (!known.ok()) {
            return known;
        }
    }
    VOXTACT_TRY(checkThreads(desc.threads));
    VOXTACT_TRY(checkSamples(desc.samplesPerVoxel));
    return checkResolution(desc.resolution);
}

} // namespace

Detector::Detector(std::unique_ptr<DetectorImpl> impl) noexcept : impl_(std::move(impl)) {}
Detector::Detector(Detector&&) noexcept = default;
Detector& Detector::operator=(Detector&&) noexcept = default;
Detector::~Detector() = default;

Result<Detector> Detector::create(const DetectorDesc& desc) {
    return guard([&]() -> Result<Detector> {
        VOXTACT_TRY(checkDesc(desc));
        VOXTACT_TRY(checkOutputs(desc));
        const std::uint32_t processors = std::max(std::thread::hardware_concurrency(), 1U);
        return Detector(std::make_unique<DetectorImpl>(desc, desc.threads == 0 ? processors : desc.threads));
    });
}

Result<BatchAnswer> Detector::detect(const Batch& batch) {
    return guard([&]() -> Result<BatchAnswer> {
        const auto start = std::chrono::steady_clock::now();
        const Result<std::uint32_t> pairs = checkBatch(impl_->desc, batch);
        VOXTACT_TRY(pairs);
        VOXTACT_TRY(checkLabelMaps(batch, impl_->desc.outputs));
        const Cancellation cancel(batch.cancel);
        VOXTACT_TRY(checkNotCancelled(cancel));
        DetectorImpl& impl = *impl_;
        BatchAnswer answer =
            rowOf(impl.desc.projection).certified
                ? runCertified(batch, cancel, *pairs, impl.desc, impl.pool, impl.certified)
                : runCounts(batch, cancel, *pairs, impl.desc, {impl.pool, impl.scratches}, impl.occupancies);
        VOXTACT_TRY(checkNotCancelled(cancel));
        answer.wallMilliseconds =
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        return answer;
    });
}

std::uint32_t Detector::threads() const noexcept {
    return impl_->pool.threads();
}

} // namespace voxtact::cpu
