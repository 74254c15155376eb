// SPDX-License-Identifier: MIT
#include "core/guard.h"
#include "core/pair_transform.h"
#include "cpu/batch_check.h"
#include "cpu/kernel.h"
#include "cpu/occupancy_cache.h"
#include "cpu/outputs.h"
#include "cpu/thread_pool.h"

#include <algorithm>
#include <atomic>
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
    OccupancyCache occupancies;
};

namespace {

/// A pair is split only where its parts keep a thread busy for longer than it takes to wake it.
constexpr std::uint32_t kFewestClusters = 16;
/// Parts a thread, so that unequal ones even out.
constexpr std::uint32_t kPartsPerThread = 4;

struct ItemFacts {
    std::shared_ptr<const Occupancy> occupancy;
    std::uint32_t firstPair;
    std::uint32_t parts; ///< of each of its pairs
    std::uint64_t firstTask;
};

/// A batch cut into tasks that threads take one by one.
class Run {
  public:
    Run(const Batch& batch, DetectorImpl& detector, std::uint32_t pairs)
        : batch_(batch), detector_(detector), view_(batch.view, detector.desc.boundary != Boundary::Clamp),
          counts_(pairs) {
        const std::uint32_t wanted = detector.pool.threads() == 1 || pairs == 0
                                         ? 1
                                         : std::max(detector.pool.threads() * kPartsPerThread / pairs, 1U);
        std::uint32_t pair = 0;
        for (const BatchItem& item : batch.items) {
            const std::size_t clusters = item.mesh->impl().clusters.size();
            const auto most = static_cast<std::uint32_t>(std::max<std::size_t>(clusters / kFewestClusters, 1));
            const std::uint32_t parts = std::min(wanted, most);
            items_.push_back(
                {detector.occupancies.get(item.volume->impl(), item.transferFunction->impl(), batch.threshold), pair,
                 parts, tasks_});
            pair += static_cast<std::uint32_t>(item.world_from_object.size());
            tasks_ += item.world_from_object.size() * parts;
        }
        if (detector.desc.outputs.any()) {
            outputs_.emplace(batch, detector.desc, pairs, detector.pool.threads());
        }
    }

    void count() {
        const auto threads = static_cast<std::uint32_t>(std::min<std::uint64_t>(detector_.pool.threads(), tasks_));
        if (threads == 0) {
            return;
        }
        detector_.pool.run(threads, [this](std::uint32_t thread) {
            for (std::uint64_t task = next_++; task < tasks_; task = next_++) {
                runTask(task, thread);
            }
        });
    }

    /// Once counted.
    void finishOutputs(BatchAnswer& answer) {
        if (outputs_) {
            outputs_->finish(answer);
        }
    }

    [[nodiscard]] std::vector<PairAnswer> answers() const {
        std::vector<PairAnswer> out;
        out.reserve(counts_.size());
        for (std::size_t i = 0; i < items_.size(); ++i) {
            for (std::size_t pose = 0; pose < batch_.items[i].world_from_object.size(); ++pose) {
                const auto pair = static_cast<std::uint32_t>(out.size());
                out.push_back(answer(pair, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(pose)));
            }
        }
        return out;
    }

  private:
    void runTask(std::uint64_t task, std::uint32_t thread) noexcept {
        const auto after =
            std::upper_bound(items_.begin(), items_.end(), task,
                             [](std::uint64_t t, const ItemFacts& facts) { return t < facts.firstTask; });
        // Items without poses have no task: the last that begins at or before it has some.
        const ItemFacts& facts = *(after - 1);
        const std::size_t number = static_cast<std::size_t>(after - items_.begin()) - 1;
        const BatchItem& item = batch_.items[number];
        const std::uint64_t within = task - facts.firstTask;
        const auto pose = static_cast<std::size_t>(within / facts.parts);
        std::atomic<std::uint64_t>& count = counts_[facts.firstPair + pose];
        if (facts.occupancy->nothingOpaque() ||
            (detector_.desc.stopAtFirst && count.load(std::memory_order_relaxed) > 0)) {
            return;
        }
        const MeshImpl& mesh = item.mesh->impl();
        const VolumeImpl& volume = item.volume->impl();
        const shader::PairTransform transform =
            pairTransform(batch_.view.clip_from_world, item.world_from_object[pose], volume.texture_from_world);
        const std::uint64_t clusters = mesh.clusters.size();
        const std::uint64_t part = within % facts.parts;
        const PairJob job{.mesh = mesh,
                          .volume = volume,
                          .occupancy = *facts.occupancy,
                          .view = view_,
                          .transform = transform,
                          .orthographic = isOrthographic(transform),
                          .cull = CullForms(mesh, transform),
                          .clusterBegin = static_cast<std::uint32_t>(clusters * part / facts.parts),
                          .clusterEnd = static_cast<std::uint32_t>(clusters * (part + 1) / facts.parts),
                          .stopAtFirst = detector_.desc.stopAtFirst};
        const std::uint64_t survivors =
            outputs_ ? outputs_->collect(job, number, facts.firstPair + static_cast<std::uint32_t>(pose), thread)
                     : countSurvivors(job, *detector_.scratches[thread]);
        count.fetch_add(survivors, std::memory_order_relaxed);
    }

    [[nodiscard]] PairAnswer answer(std::uint32_t pair, std::uint32_t item, std::uint32_t pose) const {
        const bool first = detector_.desc.stopAtFirst;
        const std::uint64_t count = counts_[pair].load(std::memory_order_relaxed);
        return {.pair = pair,
                .item = item,
                .pose = pose,
                .hit = count > 0,
                .count = first && count > 0 ? 1 : count,
                .exactness = first ? Exactness::LowerBound : Exactness::Exact,
                .method = CountingMethod::Cpu,
                .projection = Projection::View};
    }

    const Batch& batch_;
    DetectorImpl& detector_;
    ViewFacts view_;
    std::vector<ItemFacts> items_;
    std::vector<std::atomic<std::uint64_t>> counts_;
    std::optional<OutputRun> outputs_;
    std::uint64_t tasks_ = 0;
    std::atomic<std::uint64_t> next_{0};
};

} // namespace

Detector::Detector(std::unique_ptr<DetectorImpl> impl) noexcept : impl_(std::move(impl)) {}
Detector::Detector(Detector&&) noexcept = default;
Detector& Detector::operator=(Detector&&) noexcept = default;
Detector::~Detector() = default;

Result<Detector> Detector::create(const DetectorDesc& desc) {
    return guard([&]() -> Result<Detector> {
        if (desc.projection != Projection::View) {
            return Error{ErrorCode::Unsupported, 0, std::string("the projection ") + toString(desc.projection)};
        }
        if (Result<void> outputs = checkOutputs(desc); !outputs.ok()) {
            return outputs.error();
        }
        const std::uint32_t processors = std::max(std::thread::hardware_concurrency(), 1U);
        return Detector(std::make_unique<DetectorImpl>(desc, desc.threads == 0 ? processors : desc.threads));
    });
}

Result<BatchAnswer> Detector::detect(const Batch& batch) {
    return guard([&]() -> Result<BatchAnswer> {
        const auto start = std::chrono::steady_clock::now();
        const Result<std::uint32_t> pairs = checkBatch(batch);
        if (!pairs.ok()) {
            return pairs.error();
        }
        if (Result<void> labels = checkLabelMaps(batch, impl_->desc.outputs); !labels.ok()) {
            return labels.error();
        }
        Run run(batch, *impl_, *pairs);
        run.count();
        BatchAnswer answer;
        answer.pairs = run.answers();
        run.finishOutputs(answer);
        answer.wallMilliseconds =
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        return answer;
    });
}

std::uint32_t Detector::threads() const noexcept {
    return impl_->pool.threads();
}

} // namespace voxtact::cpu
