// SPDX-License-Identifier: MIT
#include "host/tasks.h"
#include "host/scene/scene_impl.h"

#include <algorithm>
#include <atomic>

namespace voxtact::cpu {

namespace {

/// A pair is split only where its parts keep a thread busy for longer than it takes to wake it.
constexpr std::uint32_t kFewestClusters = 16;
/// Parts per thread, so that unequal ones even out.
constexpr std::uint32_t kPartsPerThread = 4;

} // namespace

Tasks::Tasks(const Batch& batch, const Cancellation& cancel, std::uint32_t pairs, std::uint32_t threads)
    : cancel_(&cancel) {
    const std::uint32_t wanted = threads == 1 || pairs == 0 ? 1 : std::max(threads * kPartsPerThread / pairs, 1U);
    std::uint32_t pair = 0;
    for (const BatchItem& item : batch.items) {
        const auto clusters = static_cast<std::uint32_t>(item.mesh->impl().clusters.size());
        const std::uint32_t parts = std::min(wanted, std::max(clusters / kFewestClusters, 1U));
        items_.push_back({pair, parts, clusters, count_});
        pair += static_cast<std::uint32_t>(item.world_from_object.size());
        count_ += item.world_from_object.size() * parts;
    }
}

Task Tasks::at(std::uint64_t task) const noexcept {
    const auto after = std::upper_bound(items_.begin(), items_.end(), task,
                                        [](std::uint64_t t, const Item& item) { return t < item.firstTask; });
    // Items without poses have no task: the last that begins at or before it has some.
    const Item& item = *(after - 1);
    const std::uint64_t within = task - item.firstTask;
    const auto pose = static_cast<std::uint32_t>(within / item.parts);
    const std::uint64_t part = within % item.parts;
    return {static_cast<std::uint32_t>(after - items_.begin()) - 1, pose, item.firstPair + pose,
            static_cast<std::uint32_t>(item.clusters * part / item.parts),
            static_cast<std::uint32_t>(item.clusters * (part + 1) / item.parts)};
}

void Tasks::run(ThreadPool& pool, const std::function<void(const Task&, std::uint32_t thread)>& body) const {
    std::atomic<std::uint64_t> next{0};
    const auto step = [&](std::uint32_t thread) {
        const std::uint64_t task = next++;
        const bool some = task < count_ && !isCancelled(cancel_);
        if (some) {
            body(at(task), thread);
        }
        return some;
    };
    pool.run(count_, step, WakeOthers::Predicted);
}

} // namespace voxtact::cpu
