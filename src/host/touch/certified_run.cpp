// SPDX-License-Identifier: MIT
#include "host/touch/certified_run.h"
#include "core/method/certified_constants.h"
#include "host/outputs.h"
#include "host/tasks.h"
#include "host/touch/certified_pair.h"

#include <atomic>
#include <memory>
#include <optional>

namespace voxtact::cpu {

namespace {

/// Common results of a pair's tasks.
struct PairTally {
    std::atomic<std::uint64_t> certain{0};
    std::atomic<bool> undecided{false};
};

PairAnswer answerOf(const PairTally& tally, const Task& at, bool stopAtFirst) {
    const std::uint64_t certain = tally.certain.load(std::memory_order_relaxed);
    const bool undecided = tally.undecided.load(std::memory_order_relaxed);
    PairAnswer answer;
    answer.pair = at.pair;
    answer.item = at.item;
    answer.pose = at.pose;
    answer.hit = certain > 0;
    answer.possible = certain == 0 && undecided;
    answer.count = stopAtFirst && certain > 0 ? 1 : certain;
    answer.exactness = stopAtFirst || undecided ? Exactness::LowerBound : Exactness::Exact;
    answer.method = CountingMethod::Cpu;
    answer.projection = Projection::Certified;
    return answer;
}

} // namespace

BatchAnswer runCertified(const Batch& batch, const Cancellation& cancel, std::uint32_t pairs, const Count& desc,
                         ThreadPool& pool, CertifiedOccupancies& occupancies) {
    std::vector<std::shared_ptr<const CertifiedOccupancy>> ofItem;
    for (const BatchItem& item : batch.items) {
        ofItem.push_back(
            occupancies.get(item.volume->impl(), item.transferFunction->impl(), batch.threshold, desc.resolution));
    }
    std::vector<PairTally> tallies(pairs);
    std::optional<OutputRun> outputs;
    if (desc.outputs.any()) {
        outputs.emplace(batch, desc, pairs, pool.threads());
    }
    const Tasks tasks(batch, cancel, pairs, pool.threads());
    tasks.run(pool, [&](const Task& task, std::uint32_t thread) {
        PairTally& tally = tallies[task.pair];
        if (desc.stopAtFirst && tally.certain.load(std::memory_order_relaxed) > 0) {
            return;
        }
        const BatchItem& item = batch.items[task.item];
        const VolumeImpl& volume = item.volume->impl();
        const MeshImpl& mesh = item.mesh->impl();
        const CertifiedJob job{mesh,
                               volume,
                               *ofItem[task.item],
                               certifiedPair(volume.pairGrid, item.world_from_object[task.pose], mesh.origin),
                               task.clusterBegin,
                               task.clusterEnd,
                               desc.stopAtFirst,
                               &cancel};
        CertifiedTally found;
        if (outputs) {
            outputs->collect(task.item, task.pair, thread, [&](OutputRun::Sink& sink) {
                found = decide(job, [&](std::uint32_t triangle, const shader::CertifiedProof& proof) {
                    const shader::VoxelPoint& at = proof.texture;
                    sink.add(triangle, {at.x, at.y, at.z}, shader::ContactSample{proof.stored, proof.opacity});
                });
            });
        } else {
            found = decide(job);
        }
        tally.certain.fetch_add(found.certain, std::memory_order_relaxed);
        if (found.undecided) {
            tally.undecided.store(true, std::memory_order_relaxed);
        }
    });
    BatchAnswer answer;
    answer.pairs.reserve(pairs);
    for (std::uint32_t i = 0; i < batch.items.size(); ++i) {
        for (std::uint32_t pose = 0; pose < batch.items[i].world_from_object.size(); ++pose) {
            const auto pair = static_cast<std::uint32_t>(answer.pairs.size());
            answer.pairs.push_back(answerOf(tallies[pair], {i, pose, pair}, desc.stopAtFirst));
        }
    }
    if (outputs) {
        outputs->finish(answer);
    }
    return answer;
}

} // namespace voxtact::cpu
