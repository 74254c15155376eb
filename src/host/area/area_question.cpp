// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/batch/output_pair.h"
#include "core/facts/facts.h"
#include "host/area/area_search.h"
#include "host/batch_check.h"
#include "host/host_engine.h"
#include "host/search/label_part.h"

#include <algorithm>
#include <map>

namespace voxtact::cpu {

namespace {

Result<void> checkArea(const Area& question) {
    VOXTACT_TRY(checkFact(factOf("area", "tolerance"), question.tolerance));
    VOXTACT_TRY(checkSteps(question.maxSteps));
    if (question.triangles && question.labels) {
        return refuse("areas are measured by triangle or by label, not by both");
    }
    return checkFact(factOf("count", "resolution"), question.resolution);
}

AreaGoal goalOf(const Area& question, CancelFlag cancel) {
    return {question.tolerance, question.maxSteps, cancel};
}

/// Returns true if the mesh may touch; it is then in `memory`. A mesh that certainly does not touch has area 0.
bool placeIfItMayTouch(const PairAt& at, ThreadMemory& memory) {
    std::optional<TouchPoint> point;
    const CertifiedTally touch = at.touch(point);
    if (touch.certain == 0 && !touch.undecided) {
        return false;
    }
    memory.mesh.begin(at.mesh(), at.part.space, at.world_from_object);
    return true;
}

/// The requested labels of one map.
struct Slots {
    static constexpr std::size_t kNowhere = kMaxMeasuredLabels; ///< no voxel has the label
    static_assert(kMaxMeasuredLabels < AreaLabels::kNoSlot);

    std::vector<std::uint16_t> ofValue; ///< by LabelData::values
    std::vector<std::size_t> ofAsked;   ///< by the requested labels, or kNowhere
    std::size_t count = 0;
};

Slots slotsOf(const LabelData& map, std::span<const std::int32_t> labels) {
    Slots slots;
    slots.ofValue.assign(map.values.size(), AreaLabels::kNoSlot);
    for (const std::int32_t label : labels) {
        const auto found = std::ranges::lower_bound(map.values, label);
        if (found == map.values.end() || *found != label) {
            slots.ofAsked.push_back(Slots::kNowhere);
            continue;
        }
        std::uint16_t& slot = slots.ofValue[static_cast<std::size_t>(found - map.values.begin())];
        if (slot == AreaLabels::kNoSlot) {
            slot = static_cast<std::uint16_t>(slots.count++);
        }
        slots.ofAsked.push_back(slot);
    }
    return slots;
}

/// Label maps of a batch, each checked once.
using SlotsOfMaps = std::map<const LabelData*, Slots>;

/// Results of each pair for all labels, before they are split by label.
struct PairAreas {
    std::uint32_t pair = 0;
    std::uint32_t item = 0;
    std::uint32_t pose = 0;
    std::vector<AreaFound> found; ///< by slot; empty: all are 0
};

AreaAnswer byLabel(const Batch& batch, std::span<const std::int32_t> labels, const std::vector<PairAreas>& pairs,
                   const SlotsOfMaps& slots) {
    AreaAnswer answer;
    answer.labels = numberedPairs<LabelArea>(batch, labels.size());
    for (std::size_t i = 0; i < answer.labels.size(); ++i) {
        LabelArea& area = answer.labels[i];
        area.label = labels[i % labels.size()];
        const std::vector<AreaFound>& found = pairs[area.pair].found;
        const std::size_t slot = slots.at(batch.items[area.item].labels).ofAsked[i % labels.size()];
        if (slot < found.size()) {
            area.bounds = found[slot].bounds;
            area.end = found[slot].end;
        }
    }
    return answer;
}

/// A pair, and the areas of its triangles.
struct TrianglesOfPair : PairArea {
    std::vector<TriangleFound> triangles;
};

/// Measures all pairs; `trianglesOf(pair)`: output of its triangles' areas, or null.
template <class Pair, class TrianglesOf>
Result<void> measureAll(HostEngineImpl& impl, const Area& question, const Batch& batch, std::vector<Pair>& pairs,
                        const TrianglesOf& trianglesOf) {
    const Cancellation cancel(batch.cancel);
    VOXTACT_TRY(checkNotCancelled(cancel));
    pairs = numberedPairs<Pair>(batch);
    const AreaGoal goal = goalOf(question, &cancel);
    return impl.workers.forEachPair(batch, cancel, impl.workers.partsOf(batch, question.resolution), pairs,
                                    [&](const PairAt& at, Pair& pair, ThreadMemory& memory) {
                                        if (placeIfItMayTouch(at, memory)) {
                                            const AreaFound found =
                                                measureArea(at.volume(), at.part, memory.mesh, goal, trianglesOf(pair));
                                            pair.bounds = found.bounds;
                                            pair.end = found.end;
                                        }
                                    });
}

/// Checks labels like checkLabels().
Result<SlotsOfMaps> slotsOf(const Batch& batch, std::span<const std::int32_t> labels) {
    SlotsOfMaps slots;
    for (const BatchItem& item : batch.items) {
        if (!slots.contains(item.labels)) {
            VOXTACT_TRY(checkLabels(*item.labels));
            slots.emplace(item.labels, slotsOf(*item.labels, labels));
        }
    }
    return slots;
}

Result<AreaAnswer> measurePairs(HostEngineImpl& impl, const Area& question, const Batch& batch) {
    AreaAnswer answer;
    VOXTACT_TRY(measureAll(impl, question, batch, answer.pairs, [](PairArea&) { return nullptr; }));
    return answer;
}

Result<AreaAnswer> measureTriangles(HostEngineImpl& impl, const Area& question, const Batch& batch) {
    std::vector<TrianglesOfPair> pairs;
    VOXTACT_TRY(measureAll(impl, question, batch, pairs, [](TrianglesOfPair& pair) { return &pair.triangles; }));
    AreaAnswer answer;
    std::size_t count = 0;
    for (const TrianglesOfPair& pair : pairs) {
        count += pair.triangles.size();
    }
    answer.triangles.reserve(count);
    for (TrianglesOfPair& pair : pairs) {
        answer.pairs.push_back(pair);
        for (const TriangleFound& found : pair.triangles) {
            answer.triangles.push_back({pair.pair, pair.item, pair.pose, found.triangle, found.whole, found.bounds});
        }
        pair.triangles = {};
    }
    return answer;
}

Result<AreaAnswer> measureLabels(HostEngineImpl& impl, const Area& question, const Batch& batch) {
    const std::vector<std::int32_t>& labels = *question.labels;
    VOXTACT_TRY(checkMeasuredLabels(batch, labels));
    const Cancellation cancel(batch.cancel);
    VOXTACT_TRY(checkNotCancelled(cancel));
    const Result<SlotsOfMaps> slots = slotsOf(batch, labels);
    VOXTACT_TRY(slots);
    std::vector<PairAreas> pairs = numberedPairs<PairAreas>(batch);
    const AreaGoal goal = goalOf(question, &cancel);
    VOXTACT_TRY(impl.workers.forEachPair(batch, cancel, impl.workers.partsOf(batch, question.resolution), pairs,
                                         [&](const PairAt& at, PairAreas& pair, ThreadMemory& memory) {
                                             const Slots& own = slots->at(at.item.labels);
                                             if (own.count > 0 && placeIfItMayTouch(at, memory)) {
                                                 pair.found =
                                                     measureAreas(at.volume(), at.part, memory.mesh,
                                                                  {at.item.labels, own.ofValue}, own.count, goal);
                                             }
                                         }));
    return byLabel(batch, labels, pairs, *slots);
}

} // namespace

Result<AreaAnswer> HostEngine::ask(const Area& question, const Batch& batch) {
    return guard([&]() -> Result<AreaAnswer> {
        const StopWatch watch;
        VOXTACT_TRY(checkArea(question));
        VOXTACT_TRY(checkCertifiedBatch(batch));
        Result<AreaAnswer> answer = question.labels      ? measureLabels(*impl_, question, batch)
                                    : question.triangles ? measureTriangles(*impl_, question, batch)
                                                         : measurePairs(*impl_, question, batch);
        if (answer.ok()) {
            answer->wallMilliseconds = watch.milliseconds();
        }
        return answer;
    });
}

} // namespace voxtact::cpu
