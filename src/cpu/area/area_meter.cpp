// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/batch/output_pair.h"
#include "core/method/certified_constants.h"
#include "cpu/area/area_search.h"
#include "cpu/batch_check.h"
#include "cpu/clearance/label_part.h"
#include "cpu/clearance/workers.h"

#include <algorithm>
#include <map>

namespace voxtact::cpu {

struct AreaMeterImpl {
    explicit AreaMeterImpl(const AreaDesc& chosen) : desc(chosen), workers(chosen.threads) {}

    AreaDesc desc;
    Workers workers;
};

namespace {

Result<void> checkDesc(const AreaDesc& desc) {
    constexpr double kLeastTolerance = 1e-9;
    VOXTACT_TRY(checkThreads(desc.threads));
    if (!(desc.tolerance >= kLeastTolerance && desc.tolerance < kInfinity)) {
        return refuse("the tolerance " + number(desc.tolerance) + " mm^2 is not a number from " +
                      number(kLeastTolerance) + " mm^2 on");
    }
    if (desc.mostSteps == 0) {
        return refuse("at most 0 steps are allowed, an area takes at least one step");
    }
    return checkResolution(desc.resolution);
}

AreaGoal goalOf(const AreaDesc& desc, CancelFlag cancel) {
    return {desc.tolerance, desc.mostSteps, cancel};
}

/// Whether the mesh may touch; it is then in `memory`. What certainly does not touch has no area.
bool placeIfItMayTouch(const PairAt& at, ThreadMemory& memory) {
    std::optional<TouchPoint> point;
    const CertifiedTally touch = at.touch(point);
    if (touch.certain == 0 && !touch.undecided) {
        return false;
    }
    memory.mesh.begin(at.mesh(), at.part.space, at.world_from_object);
    return true;
}

/// The labels that are asked for, of one map.
struct Slots {
    static constexpr std::size_t kNowhere = kMostMeasuredLabels; ///< no voxel has the label
    static_assert(kMostMeasuredLabels < AreaLabels::kNoSlot);

    std::vector<std::uint16_t> ofValue; ///< by LabelData::values
    std::vector<std::size_t> ofAsked;   ///< by the labels that are asked for, or kNowhere
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

/// Of a batch's maps, each of which is looked at once.
using SlotsOfMaps = std::map<const LabelData*, Slots>;

/// What each pair has for each label, before it is told label by label.
struct PairAreas {
    std::uint32_t pair = 0;
    std::uint32_t item = 0;
    std::uint32_t pose = 0;
    std::vector<AreaFound> found; ///< by slot; empty: all are 0
};

LabelAreaAnswer byLabel(const Batch& batch, std::span<const std::int32_t> labels, const std::vector<PairAreas>& pairs,
                        const SlotsOfMaps& slots) {
    LabelAreaAnswer answer;
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

/// A pair, and what its triangles have.
struct TrianglesOfPair : PairArea {
    std::vector<TriangleFound> triangles;
};

/// Measures all pairs; `trianglesOf(pair)`: where what its triangles have goes, or null.
template <class Pair, class TrianglesOf>
Result<void> measureAll(AreaMeterImpl& impl, const Batch& batch, std::vector<Pair>& pairs,
                        const TrianglesOf& trianglesOf) {
    VOXTACT_TRY(checkCertifiedBatch(batch));
    const Cancellation cancel(batch.cancel);
    VOXTACT_TRY(checkNotCancelled(cancel));
    pairs = numberedPairs<Pair>(batch);
    const AreaGoal goal = goalOf(impl.desc, &cancel);
    return impl.workers.forEachPair(batch, cancel, impl.workers.partsOf(batch, impl.desc.resolution), pairs,
                                    [&](const PairAt& at, Pair& pair, ThreadMemory& memory) {
                                        if (placeIfItMayTouch(at, memory)) {
                                            const AreaFound found =
                                                measureArea(at.volume(), at.part, memory.mesh, goal, trianglesOf(pair));
                                            pair.bounds = found.bounds;
                                            pair.end = found.end;
                                        }
                                    });
}

/// Refuses what checkLabels() refuses.
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

} // namespace

AreaMeter::AreaMeter(std::unique_ptr<AreaMeterImpl> impl) noexcept : impl_(std::move(impl)) {}
AreaMeter::AreaMeter(AreaMeter&&) noexcept = default;
AreaMeter& AreaMeter::operator=(AreaMeter&&) noexcept = default;
AreaMeter::~AreaMeter() = default;

Result<AreaMeter> AreaMeter::create(const AreaDesc& desc) {
    return guard([&]() -> Result<AreaMeter> {
        VOXTACT_TRY(checkDesc(desc));
        return AreaMeter(std::make_unique<AreaMeterImpl>(desc));
    });
}

Result<AreaAnswer> AreaMeter::measure(const Batch& batch) {
    return guard([&]() -> Result<AreaAnswer> {
        const StopWatch watch;
        AreaAnswer answer;
        VOXTACT_TRY(measureAll(*impl_, batch, answer.pairs, [](PairArea&) { return nullptr; }));
        answer.wallMilliseconds = watch.milliseconds();
        return answer;
    });
}

Result<TriangleAreaAnswer> AreaMeter::measureTriangles(const Batch& batch) {
    return guard([&]() -> Result<TriangleAreaAnswer> {
        const StopWatch watch;
        std::vector<TrianglesOfPair> pairs;
        VOXTACT_TRY(measureAll(*impl_, batch, pairs, [](TrianglesOfPair& pair) { return &pair.triangles; }));
        TriangleAreaAnswer answer;
        std::size_t count = 0;
        for (const TrianglesOfPair& pair : pairs) {
            count += pair.triangles.size();
        }
        answer.triangles.reserve(count);
        for (TrianglesOfPair& pair : pairs) {
            answer.pairs.push_back(pair);
            for (const TriangleFound& found : pair.triangles) {
                answer.triangles.push_back(
                    {pair.pair, pair.item, pair.pose, found.triangle, found.whole, found.bounds});
            }
            pair.triangles = {};
        }
        answer.wallMilliseconds = watch.milliseconds();
        return answer;
    });
}

Result<LabelAreaAnswer> AreaMeter::measureLabels(const Batch& batch, std::span<const std::int32_t> labels) {
    return guard([&]() -> Result<LabelAreaAnswer> {
        const StopWatch watch;
        VOXTACT_TRY(checkCertifiedBatch(batch));
        VOXTACT_TRY(checkMeasuredLabels(batch, labels));
        const Cancellation cancel(batch.cancel);
        VOXTACT_TRY(checkNotCancelled(cancel));
        const Result<SlotsOfMaps> slots = slotsOf(batch, labels);
        VOXTACT_TRY(slots);
        std::vector<PairAreas> pairs = numberedPairs<PairAreas>(batch);
        Workers& workers = impl_->workers;
        const AreaGoal goal = goalOf(impl_->desc, &cancel);
        VOXTACT_TRY(workers.forEachPair(batch, cancel, workers.partsOf(batch, impl_->desc.resolution), pairs,
                                        [&](const PairAt& at, PairAreas& pair, ThreadMemory& memory) {
                                            const Slots& own = slots->at(at.item.labels);
                                            if (own.count > 0 && placeIfItMayTouch(at, memory)) {
                                                pair.found =
                                                    measureAreas(at.volume(), at.part, memory.mesh,
                                                                 {at.item.labels, own.ofValue}, own.count, goal);
                                            }
                                        }));
        LabelAreaAnswer answer = byLabel(batch, labels, pairs, *slots);
        answer.wallMilliseconds = watch.milliseconds();
        return answer;
    });
}

std::uint32_t AreaMeter::threads() const noexcept {
    return impl_->workers.threads();
}

} // namespace voxtact::cpu
