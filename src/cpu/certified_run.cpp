// SPDX-License-Identifier: MIT
#include "cpu/certified_run.h"
#include "core/certified_constants.h"
#include "cpu/certified_pair.h"
#include "cpu/tasks.h"

#include <algorithm>
#include <atomic>
#include <memory>

namespace voxtact::cpu {

namespace {

/// What the tasks of a pair find together.
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
    answer.projection = Projection::Conservative;
    return answer;
}

} // namespace

BatchAnswer runCertified(const Batch& batch, std::uint32_t pairs, const DetectorDesc& desc, ThreadPool& pool,
                         CertifiedOccupancies& occupancies) {
    std::vector<std::shared_ptr<const CertifiedOccupancy>> ofItem;
    for (const BatchItem& item : batch.items) {
        ofItem.push_back(
            occupancies.get(item.volume->impl(), item.transferFunction->impl(), batch.threshold, desc.resolution));
    }
    std::vector<PairTally> tallies(pairs);
    std::vector<std::vector<TouchedTriangle>> touched(pool.threads());
    const Tasks tasks(batch, pairs, pool.threads());
    tasks.run(pool, [&](const Task& task, std::uint32_t thread) {
        PairTally& tally = tallies[task.pair];
        if (desc.stopAtFirst && tally.certain.load(std::memory_order_relaxed) > 0) {
            return;
        }
        const BatchItem& item = batch.items[task.item];
        const VolumeImpl& volume = item.volume->impl();
        CertifiedSink sink;
        if (desc.outputs.triangles) {
            sink = [&, thread](std::uint32_t triangle, const shader::VoxelPoint&) {
                std::vector<TouchedTriangle>& list = touched[thread];
                if (list.empty() || list.back().pair != task.pair || list.back().triangle != triangle) {
                    list.push_back({task.pair, triangle, 0});
                }
                ++list.back().count;
            };
        }
        const CertifiedTally found =
            decide({item.mesh->impl(), volume, *ofItem[task.item],
                    certifiedPair(volume.grid, volume.texture_from_world, item.world_from_object[task.pose]),
                    task.clusterBegin, task.clusterEnd, desc.stopAtFirst},
                   sink);
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
    for (const std::vector<TouchedTriangle>& list : touched) {
        answer.triangles.insert(answer.triangles.end(), list.begin(), list.end());
    }
    // All fragments of a triangle are in one task: no triangle is in the list twice.
    std::sort(answer.triangles.begin(), answer.triangles.end(), [](const TouchedTriangle& a, const TouchedTriangle& b) {
        return a.pair != b.pair ? a.pair < b.pair : a.triangle < b.triangle;
    });
    return answer;
}

} // namespace voxtact::cpu
