// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/batch/output_pair.h"
#include "core/facts/facts.h"
#include "host/batch_check.h"
#include "host/host_engine.h"
#include "host/overlap/containment.h"
#include "host/overlap/enclosed.h"
#include "host/overlap/overlap_pair.h"
#include "host/search/label_part.h"
#include "host/search/workers.h"

#include <algorithm>
#include <cmath>
#include <list>
#include <map>
#include <mutex>

namespace voxtact::cpu {

namespace {

/// Values that were made of others, the last ones used.
template <class Key, class Value> class LastUsed {
  public:
    template <class Make> std::shared_ptr<Value> get(const Key& key, std::size_t room, const Make& make) {
        const auto found = std::ranges::find(entries_, key, &Entry::key);
        if (found != entries_.end()) {
            entries_.splice(entries_.end(), entries_, found);
            return entries_.back().value;
        }
        std::shared_ptr<Value> value = make();
        while (entries_.size() >= room) {
            entries_.pop_front();
        }
        entries_.push_back({key, value});
        return value;
    }

  private:
    struct Entry {
        Key key;
        std::shared_ptr<Value> value;
    };
    std::list<Entry> entries_;
};

/// Surfaces that are kept for their memory.
class SpareSurfaces {
  public:
    std::unique_ptr<PairSurface> take() {
        const std::lock_guard lock(mutex_);
        if (spare_.empty()) {
            return std::make_unique<PairSurface>();
        }
        std::unique_ptr<PairSurface> one = std::move(spare_.back());
        spare_.pop_back();
        return one;
    }
    void giveBack(std::unique_ptr<PairSurface> one) {
        const std::lock_guard lock(mutex_);
        spare_.push_back(std::move(one));
    }

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<PairSurface>> spare_;
};

constexpr std::size_t kKept = 16;

} // namespace

struct OverlapMeterImpl {
    /// By volume, function and threshold; by volume and a limit of bands, which may be minus infinity.
    LastUsed<std::tuple<std::uint64_t, std::uint64_t, double>, const OverlapPart> parts;
    LastUsed<std::pair<std::uint64_t, double>, const OverlapPart> limits;
    LastUsed<std::uint64_t, const SolidSurface> solids;
    SpareSurfaces surfaces;
};

namespace {

Result<void> checkLimits(std::span<const double> limits) {
    if (limits.size() > kMaxBandLimits) {
        return Error{ErrorCode::LimitExceeded, 0,
                     std::to_string(limits.size()) + " band limits are given, one call takes at most " +
                         std::to_string(kMaxBandLimits)};
    }
    for (std::size_t i = 0; i < limits.size(); ++i) {
        if (!std::isfinite(limits[i])) {
            return refuse("band limit " + std::to_string(i) + " is not finite");
        }
        if (i > 0 && !(limits[i - 1] < limits[i])) {
            return refuse("band limit " + number(limits[i]) + " follows " + number(limits[i - 1]) +
                          "; band limits must ascend");
        }
    }
    return {};
}

Result<void> checkQuestion(const Overlap& question, const Batch& batch) {
    VOXTACT_TRY(checkCertifiedBatch(batch));
    VOXTACT_TRY(checkFact(factOf("overlap", "tolerance"), question.tolerance));
    if (question.maxSteps == 0) {
        return refuse("at most 0 steps are allowed, an overlap takes at least one step");
    }
    VOXTACT_TRY(checkLimits(question.bandLimits));
    return question.labels.empty() ? Result<void>{} : checkMeasuredLabels(batch, question.labels);
}

/// Prepared items of a batch, in order.
struct Items {
    std::vector<OverlapItem> items;
    std::map<const LabelData*, OverlapLabels> labels;
};

std::shared_ptr<const OverlapPart> limitPart(OverlapMeterImpl& impl, const VolumeImpl& volume, double limit,
                                             std::size_t room) {
    return impl.limits.get({volume.id, limit}, room, [&] {
        TransferFunctionImpl function;
        function.points = {{0, 1}};
        if (limit > -kInfinity) {
            function.points = {{limit, 0}, {limit, 1}};
        }
        return std::make_shared<const OverlapPart>(volume, function, 1.0);
    });
}

Result<void> makeItem(OverlapMeterImpl& impl, const Overlap& question, const Batch& batch, std::size_t number,
                      Items& out) {
    const BatchItem& item = batch.items[number];
    const VolumeImpl& volume = item.volume->impl();
    const TransferFunctionImpl& function = item.transferFunction->impl();
    const std::size_t room = std::max(kKept, batch.items.size());
    OverlapItem& made = out.items.emplace_back();
    made.solid = impl.solids.get(item.mesh->impl().id, room,
                                 [&] { return std::make_shared<const SolidSurface>(item.mesh->impl()); });
    if (made.solid->facts.holes > 0) {
        return refuse("batch item " + std::to_string(number) + ": the mesh has " + holesText(made.solid->facts));
    }
    made.part = impl.parts.get({volume.id, function.id, batch.threshold}, room,
                               [&] { return std::make_shared<const OverlapPart>(volume, function, batch.threshold); });
    if (!question.bandLimits.empty()) {
        const std::size_t limits = std::max(kKept, (question.bandLimits.size() + 1) * batch.items.size());
        made.limits.push_back(limitPart(impl, volume, -kInfinity, limits));
        for (const double limit : question.bandLimits) {
            made.limits.push_back(limitPart(impl, volume, limit, limits));
        }
    }
    if (!question.labels.empty()) {
        if (!out.labels.contains(item.labels)) {
            VOXTACT_TRY(checkLabels(*item.labels));
            out.labels.emplace(item.labels, OverlapLabels(*item.labels, question.labels));
        }
        made.labels = &out.labels.at(item.labels);
    }
    return {};
}

Result<Items> makeItems(HostEngineImpl& impl, const Overlap& question, const Batch& batch, const Cancellation& cancel) {
    VOXTACT_TRY(checkNotCancelled(cancel));
    if (impl.overlap == nullptr) {
        impl.overlap = std::make_shared<OverlapMeterImpl>();
    }
    Items items;
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        VOXTACT_TRY(makeItem(*impl.overlap, question, batch, i, items));
        VOXTACT_TRY(checkNotCancelled(cancel));
    }
    return items;
}

/// Result of a pair before it enters the answer.
struct MeasuredPair {
    std::uint32_t pair = 0;
    std::uint32_t item = 0;
    std::uint32_t pose = 0;
    PairMeasures measures;
};

Result<std::vector<MeasuredPair>> measurePairs(HostEngineImpl& impl, const Overlap& question, const Batch& batch,
                                               const Items& items, const Cancellation& cancel) {
    std::vector<MeasuredPair> pairs = numberedPairs<MeasuredPair>(batch);
    VOXTACT_TRY(impl.workers.forEach(pairs, cancel, [&](MeasuredPair& pair, ThreadMemory& memory) {
        const BatchItem& item = batch.items[pair.item];
        std::unique_ptr<PairSurface> surface = impl.overlap->surfaces.take();
        pair.measures = measurePair(question, items.items[pair.item], item, item.world_from_object[pair.pose],
                                    {memory.mesh, *surface}, &cancel);
        impl.overlap->surfaces.giveBack(std::move(surface));
    }));
    return pairs;
}

OverlapAnswer answerOf(const Overlap& question, const Items& items, const std::vector<MeasuredPair>& pairs) {
    OverlapAnswer answer;
    for (const MeasuredPair& one : pairs) {
        const PairMeasures& found = one.measures;
        answer.pairs.push_back(
            {one.pair, one.item, one.pose, found.whole.bounds, found.solid, found.whole.inside, found.whole.end});
        for (std::size_t band = 0; band < found.bands.size(); ++band) {
            BandOverlap& out = answer.bands.emplace_back(BandOverlap{
                .pair = one.pair, .item = one.item, .pose = one.pose, .band = static_cast<std::uint32_t>(band)});
            out.from = band == 0 ? out.from : question.bandLimits[band - 1];
            out.below = band == question.bandLimits.size() ? out.below : question.bandLimits[band];
            out.bounds = found.bands[band].bounds;
            out.end = found.bands[band].end;
        }
        for (std::size_t i = 0; i < question.labels.size(); ++i) {
            const std::uint16_t slot = items.items[one.item].labels->ofAsked[i];
            const Measure label = slot == OverlapLabels::kNoSlot ? Measure{} : found.labels[slot];
            answer.labels.push_back(
                {one.pair, one.item, one.pose, question.labels[i], label.bounds, label.inside, label.end});
        }
    }
    return answer;
}

} // namespace

Result<void> checkSolids(HostEngineImpl& impl, const Batch& batch) {
    VOXTACT_TRY(makeItems(impl, {}, batch, Cancellation(batch.cancel)));
    return {};
}

Result<std::vector<Enclosed>> enclosedIn(HostEngineImpl& impl, const Batch& batch, double tolerance) {
    const Overlap question{.tolerance = tolerance};
    const Cancellation cancel(batch.cancel);
    Result<Items> items = makeItems(impl, question, batch, cancel);
    VOXTACT_TRY(items);
    for (OverlapItem& item : items->items) {
        item.wantsPoint = true;
    }
    const Result<std::vector<MeasuredPair>> pairs = measurePairs(impl, question, batch, *items, cancel);
    VOXTACT_TRY(pairs);
    std::vector<Enclosed> out;
    for (const MeasuredPair& pair : *pairs) {
        const Containment inside = pair.measures.whole.inside;
        const std::optional<Vec3>& point = pair.measures.inside;
        out.push_back({inside == Containment::None                  ? Verdict::No
                       : inside == Containment::Undecided && !point ? Verdict::Undecided
                                                                    : Verdict::Yes,
                       point});
    }
    return out;
}

Result<OverlapAnswer> HostEngine::ask(const Overlap& question, const Batch& batch) {
    return guard([&]() -> Result<OverlapAnswer> {
        const StopWatch watch;
        VOXTACT_TRY(checkQuestion(question, batch));
        const Cancellation cancel(batch.cancel);
        const Result<Items> items = makeItems(*impl_, question, batch, cancel);
        VOXTACT_TRY(items);
        const Result<std::vector<MeasuredPair>> pairs = measurePairs(*impl_, question, batch, *items, cancel);
        VOXTACT_TRY(pairs);
        OverlapAnswer answer = answerOf(question, *items, *pairs);
        answer.wallMilliseconds = watch.milliseconds();
        return answer;
    });
}

} // namespace voxtact::cpu
