// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/batch/output_pair.h"
#include "core/facts/facts.h"
#include "core/geometry/closest_gradient.h"
#include "core/geometry/glm_bridge.h"
#include "core/volume/label_grid.h"
#include "host/batch_check.h"
#include "host/host_engine.h"
#include "host/overlap/enclosed.h"
#include "host/search/label_fingerprint.h"
#include "host/search/label_part.h"
#include "host/search/nearest_point.h"
#include "host/search/opaque_next_to.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

Result<void> checkDistance(const Distance& question) {
    VOXTACT_TRY(checkFact(factOf("distance", "tolerance"), question.tolerance));
    VOXTACT_TRY(checkFact(factOf("distance", "max"), question.maximum));
    VOXTACT_TRY(checkSteps(question.maxSteps));
    if (question.solid && question.labels) {
        return refuse("distances to labels are those of the surface; leave out solid, or the labels");
    }
    return checkFact(factOf("count", "resolution"), question.resolution);
}

WitnessPoints closestOf(const Found& found, const MeshPlace& mesh, const VolumeSpace& space) {
    WitnessPoints out;
    out.triangle = mesh.mesh().numbers[found.triangle];
    out.mesh = fromGlm(found.onMesh + space.middle);
    out.volume = fromGlm(found.inVolume + space.middle);
    setGradient(out, fromGlm(found.inVolume - found.onMesh), fromGlm(found.onMesh - mesh.origin()));
    return out;
}

/// A touch, and its witness.
bool touches(const PairAt& at, CertifiedTally& tally, PairDistance& out) {
    std::optional<TouchPoint> point;
    tally = at.touch(point);
    if (tally.certain == 0) {
        return false;
    }
    WitnessPoints closest;
    if (point) {
        closest.triangle = point->triangle;
        closest.mesh = closest.volume = opaqueNextTo(at, point->position);
    }
    out.closest = closest;
    return true;
}

StopReason endOf(const Bounds& bounds, const Found& found, double tolerance) {
    const bool closed = bounds.lower == kInfinity || bounds.upper - bounds.lower <= tolerance;
    return closed ? StopReason::Closed : (found.exhausted ? StopReason::Budget : StopReason::Rounding);
}

/// Sets both if the maximum is reached.
bool isBeyond(const Distance& question, Bounds& bounds, StopReason& end) {
    if (!(bounds.lower >= question.maximum && bounds.lower < kInfinity)) {
        return false;
    }
    bounds = {question.maximum, kInfinity};
    end = StopReason::Beyond;
    return true;
}

SearchGoal goalOf(const Distance& question) {
    return {.tolerance = question.tolerance,
            .maximum = question.maximum,
            .finest = question.tolerance / 4,
            .maxSteps = question.maxSteps};
}

void measurePair(const PairAt& at, const Distance& question, ThreadMemory& memory, PairDistance& out) {
    CertifiedTally touch;
    if (touches(at, touch, out)) {
        return;
    }
    const Found found = at.search(memory, goalOf(question));
    out.bounds = {touch.undecided ? 0 : found.lo, found.hi};
    if (isBeyond(question, out.bounds, out.end)) {
        return;
    }
    out.end = endOf(out.bounds, found, question.tolerance);
    if (found.hi < kInfinity) {
        out.closest = closestOf(found, memory.mesh, at.part.space);
    }
}

void measureLabel(const PairAt& at, const SearchedPart& searched, const Distance& question, ThreadMemory& memory,
                  LabelDistance& out) {
    const Found found = at.search(memory, searched, goalOf(question));
    out.bounds = {found.lo, found.hi};
    if (!isBeyond(question, out.bounds, out.end)) {
        out.end = endOf(out.bounds, found, question.tolerance);
    }
}

/// Returns each label's index once; skips labels that the map does not have.
std::vector<std::uint32_t> indicesOf(const LabelData& labels, std::span<const std::int32_t> wanted) {
    std::vector<std::uint32_t> indices;
    for (const std::int32_t label : wanted) {
        const auto found = std::lower_bound(labels.values.begin(), labels.values.end(), label);
        const auto index = static_cast<std::uint32_t>(found - labels.values.begin());
        if (found != labels.values.end() && *found == label && std::ranges::find(indices, index) == indices.end()) {
            indices.push_back(index);
        }
    }
    return indices;
}

/// Checks labels like checkLabels().
Result<LabelSets> setsOf(HostEngineImpl& impl, const BatchItem& item, const std::shared_ptr<const OpaquePart>& part,
                         std::uint64_t labels, const std::vector<std::uint32_t>& indices) {
    constexpr std::size_t kMostKept = 4;
    for (const KeptLabels& kept : impl.labels) {
        if (kept.part == part && kept.labels == labels && kept.indices == indices) {
            return kept.sets;
        }
    }
    VOXTACT_TRY(checkLabels(*item.labels));
    auto made =
        std::make_shared<const std::vector<LabelSet>>(singleLabels(*part, item.volume->impl(), *item.labels, indices));
    if (impl.labels.size() == kMostKept) {
        impl.labels.erase(impl.labels.begin());
    }
    impl.labels.push_back({part, labels, indices, made});
    return made;
}

Result<DistanceAnswer> measurePairs(HostEngineImpl& impl, const Distance& question, const Batch& batch) {
    const Cancellation cancel(batch.cancel);
    VOXTACT_TRY(checkNotCancelled(cancel));
    DistanceAnswer answer;
    answer.pairs = numberedPairs<PairDistance>(batch);
    Workers& workers = impl.workers;
    VOXTACT_TRY(workers.forEachPair(
        batch, cancel, workers.partsOf(batch, question.resolution), answer.pairs,
        [&](const PairAt& at, PairDistance& pair, ThreadMemory& memory) { measurePair(at, question, memory, pair); }));
    return answer;
}

Result<DistanceAnswer> measureLabels(HostEngineImpl& impl, const Distance& question, const Batch& batch) {
    const std::vector<std::int32_t>& labels = *question.labels;
    VOXTACT_TRY(checkMeasuredLabels(batch, labels));
    const Cancellation cancel(batch.cancel);
    VOXTACT_TRY(checkNotCancelled(cancel));
    const Parts parts =
        question.labelsAtAnyOpacity ? impl.workers.wholesOf(batch) : impl.workers.partsOf(batch, question.resolution);
    std::vector<std::vector<std::uint32_t>> indices;
    std::vector<LabelSets> sets;
    std::map<const LabelData*, std::uint64_t> fingerprints; // each of the call's maps is read once
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const BatchItem& item = batch.items[i];
        const auto [print, isNew] = fingerprints.try_emplace(item.labels);
        print->second = isNew ? labelFingerprint(*item.labels) : print->second;
        indices.push_back(indicesOf(*item.labels, labels));
        Result<LabelSets> made = setsOf(impl, item, parts[i], print->second, indices[i]);
        VOXTACT_TRY(made);
        sets.push_back(std::move(*made));
    }
    DistanceAnswer answer;
    answer.labels = numberedPairs<LabelDistance>(batch, labels.size());
    for (std::size_t i = 0; i < answer.labels.size(); ++i) {
        answer.labels[i].label = labels[i % labels.size()];
        answer.labels[i].bounds = {kInfinity, kInfinity};
    }
    VOXTACT_TRY(impl.workers.forEachPair(batch, cancel, parts, answer.labels,
                                         [&](const PairAt& at, LabelDistance& label, ThreadMemory& memory) {
                                             const LabelData& map = *at.item.labels;
                                             const std::vector<std::uint32_t>& known = indices[label.item];
                                             for (std::size_t i = 0; i < known.size(); ++i) {
                                                 if (map.values[known[i]] == label.label) {
                                                     const SearchedPart searched((*sets[label.item])[i], map);
                                                     measureLabel(at, searched, question, memory, label);
                                                     return;
                                                 }
                                             }
                                         }));
    return answer;
}

/// The distance of a solid from that of its surface.
void setEnclosed(PairDistance& pair, const Enclosed& enclosed) {
    if (enclosed.verdict == Verdict::Undecided && pair.bounds.lower > 0) {
        pair.bounds.lower = 0;
        pair.end = StopReason::Rounding;
    } else if (enclosed.verdict == Verdict::Yes) {
        pair.bounds = {};
        pair.end = StopReason::Closed;
        pair.closest.reset();
        if (enclosed.point) {
            pair.closest = {.triangle = kInsideMesh, .mesh = *enclosed.point, .volume = *enclosed.point};
        }
    }
}

} // namespace

Result<DistanceAnswer> HostEngine::ask(const Distance& question, const Batch& batch) {
    return guard([&]() -> Result<DistanceAnswer> {
        const StopWatch watch;
        VOXTACT_TRY(checkDistance(question));
        VOXTACT_TRY(checkCertifiedBatch(batch));
        if (question.solid) {
            VOXTACT_TRY(checkSolids(*impl_, batch));
        }
        Result<DistanceAnswer> answer =
            question.labels ? measureLabels(*impl_, question, batch) : measurePairs(*impl_, question, batch);
        if (answer.ok() && question.solid) {
            VOXTACT_TRY(forEnclosed(
                *impl_, batch, answer->pairs, [](const PairDistance& pair) { return pair.bounds.upper > 0; },
                &setEnclosed));
        }
        if (answer.ok()) {
            answer->wallMilliseconds = watch.milliseconds();
        }
        return answer;
    });
}

} // namespace voxtact::cpu
