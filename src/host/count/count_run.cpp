// SPDX-License-Identifier: MIT
#include "host/count/count_run.h"
#include "core/geometry/pair_transform.h"
#include "core/geometry/projection.h"
#include "core/geometry/recentre.h"
#include "core/method/method_table.h"
#include "host/outputs.h"
#include "host/pair_job.h"
#include "host/tasks.h"

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

namespace voxtact::cpu {

namespace {

/// Data that all pairs of an item share.
struct ItemFacts {
    std::shared_ptr<const Occupancy> occupancy;
    ViewFacts view;
    shader::DominantGrid grid;
};

class CountRun {
  public:
    CountRun(const Batch& batch, const Cancellation& cancel, std::uint32_t pairs, const Count& desc,
             const Workshop& workshop, Occupancies& occupancies)
        : batch_(batch), cancel_(cancel), desc_(desc), workshop_(workshop), cameras_(desc.projection, batch.view),
          counts_(pairs) {
        for (const BatchItem& item : batch.items) {
            items_.push_back({occupancies.get(item.volume->impl(), item.transferFunction->impl(), batch.threshold),
                              viewOf(item), dominantGrid(item.volume->grid())});
        }
        if (desc.outputs.any()) {
            outputs_.emplace(batch, desc, pairs, workshop.pool.threads());
        }
    }

    BatchAnswer run() {
        const auto pairs = static_cast<std::uint32_t>(counts_.size());
        Tasks(batch_, cancel_, pairs, workshop_.pool.threads())
            .run(workshop_.pool, [this](const Task& task, std::uint32_t thread) { runTask(task, thread); });
        BatchAnswer answer;
        answer.pairs.reserve(pairs);
        for (std::uint32_t item = 0; item < batch_.items.size(); ++item) {
            for (std::uint32_t pose = 0; pose < batch_.items[item].world_from_object.size(); ++pose) {
                answer.pairs.push_back(answerOf(static_cast<std::uint32_t>(answer.pairs.size()), item, pose));
            }
        }
        if (outputs_) {
            outputs_->finish(answer);
        }
        return answer;
    }

  private:
    [[nodiscard]] ViewFacts viewOf(const BatchItem& item) const {
        View view = batch_.view;
        if (rowOf(desc_.projection).voxelGrid) {
            view.width = static_cast<std::uint32_t>(dominantSide(item.volume->grid(), desc_.samplesPerVoxel));
            view.height = view.width;
        }
        return {view, desc_.boundary != Boundary::Clamp};
    }

    void runTask(const Task& task, std::uint32_t thread) {
        std::atomic<std::uint64_t>& count = counts_[task.pair];
        for (const Mat4& clip_from_world : cameras_.clip_from_world()) {
            if (items_[task.item].occupancy->nothingOpaque() ||
                (desc_.stopAtFirst && count.load(std::memory_order_relaxed) > 0)) {
                return;
            }
            count.fetch_add(countTask(task, clip_from_world, thread), std::memory_order_relaxed);
        }
    }

    /// A task, seen once.
    [[nodiscard]] std::uint64_t countTask(const Task& task, const Mat4& clip_from_world, std::uint32_t thread) {
        const ItemFacts& facts = items_[task.item];
        const BatchItem& item = batch_.items[task.item];
        const MeshImpl& mesh = item.mesh->impl();
        const VolumeImpl& volume = item.volume->impl();
        const shader::PairTransform transform =
            pairTransform(clip_from_world, worldFromFloats(item.world_from_object[task.pose], mesh.origin),
                          volume.texture_from_world);
        const PairJob job{.mesh = mesh,
                          .volume = volume,
                          .occupancy = *facts.occupancy,
                          .view = facts.view,
                          .transform = transform,
                          .dominantAxis = rowOf(desc_.projection).voxelGrid ? &facts.grid : nullptr,
                          .orthographic = isOrthographic(transform),
                          .cull = CullForms(mesh, transform),
                          .clusterBegin = task.clusterBegin,
                          .clusterEnd = task.clusterEnd,
                          .stopAtFirst = desc_.stopAtFirst,
                          .cancel = &cancel_};
        return outputs_ ? outputs_->collect(job, task.item, task.pair, thread)
                        : countSurvivors(job, *workshop_.scratches[thread]);
    }

    [[nodiscard]] PairAnswer answerOf(std::uint32_t pair, std::uint32_t item, std::uint32_t pose) const {
        const bool first = desc_.stopAtFirst;
        const std::uint64_t count = counts_[pair].load(std::memory_order_relaxed);
        return {.pair = pair,
                .item = item,
                .pose = pose,
                .hit = count > 0,
                .count = first && count > 0 ? 1 : count,
                .exactness = first ? Exactness::LowerBound : Exactness::Exact,
                .method = CountingMethod::Cpu,
                .projection = desc_.projection};
    }

    const Batch& batch_;
    const Cancellation& cancel_;
    const Count& desc_;
    const Workshop& workshop_;
    Cameras cameras_;
    std::vector<ItemFacts> items_;
    std::vector<std::atomic<std::uint64_t>> counts_;
    std::optional<OutputRun> outputs_;
};

} // namespace

BatchAnswer runCounts(const Batch& batch, const Cancellation& cancel, std::uint32_t pairs, const Count& desc,
                      const Workshop& workshop, Occupancies& occupancies) {
    return CountRun(batch, cancel, pairs, desc, workshop, occupancies).run();
}

} // namespace voxtact::cpu
