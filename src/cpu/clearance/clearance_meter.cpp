// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/batch/output_pair.h"
#include "core/geometry/closest_gradient.h"
#include "core/geometry/glm_bridge.h"
#include "core/method/certified_constants.h"
#include "core/volume/label_grid.h"
#include "cpu/batch_check.h"
#include "cpu/clearance/label_fingerprint.h"
#include "cpu/clearance/label_part.h"
#include "cpu/clearance/workers.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

using LabelSets = std::shared_ptr<const std::vector<LabelSet>>;

/// The labels that were asked for last.
struct KeptLabels {
    std::shared_ptr<const OpaquePart> part; ///< keeps its address from being another's
    std::uint64_t labels = 0;               ///< fingerprint of the map
    std::vector<std::uint32_t> indices;
    LabelSets sets;
};

} // namespace

struct ClearanceMeterImpl {
    explicit ClearanceMeterImpl(const ClearanceDesc& chosen) : desc(chosen), workers(chosen.threads) {}

    ClearanceDesc desc;
    Workers workers;
    std::vector<KeptLabels> labels;
};

namespace {

Result<void> checkDesc(const ClearanceDesc& desc) {
    VOXTACT_TRY(checkThreads(desc.threads));
    VOXTACT_TRY(checkTolerance(desc.tolerance));
    VOXTACT_TRY(checkMaximum(desc.maximum));
    if (desc.mostSteps == 0) {
        return refuse("at most 0 steps are allowed, a clearance takes at least one step");
    }
    return checkResolution(desc.resolution);
}

ClosestPoints closestOf(const Found& found, const MeshPlace& mesh, const VolumeSpace& space) {
    ClosestPoints out;
    out.triangle = mesh.mesh().numbers[found.triangle];
    out.mesh = fromGlm(found.onMesh + space.middle);
    out.volume = fromGlm(found.inVolume + space.middle);
    setGradient(out, fromGlm(found.inVolume - found.onMesh), fromGlm(found.onMesh - mesh.origin()));
    return out;
}

/// A touch, and its witness.
bool touches(const PairAt& at, CertifiedTally& tally, PairClearance& out) {
    std::optional<TouchPoint> point;
    tally = at.touch(point);
    if (tally.certain == 0) {
        return false;
    }
    ClosestPoints closest;
    if (point) {
        closest.triangle = point->triangle;
        closest.mesh = closest.volume = point->position;
    }
    out.closest = closest;
    return true;
}

ClearanceEnd endOf(const ClearanceBounds& bounds, const Found& found, double tolerance) {
    const bool closed = bounds.lo == kInfinity || bounds.hi - bounds.lo <= tolerance;
    return closed ? ClearanceEnd::Closed : (found.exhausted ? ClearanceEnd::Budget : ClearanceEnd::Rounding);
}

/// Both are set: the maximum is not reached.
bool isBeyond(const ClearanceDesc& desc, ClearanceBounds& bounds, ClearanceEnd& end) {
    if (!(bounds.lo >= desc.maximum && bounds.lo < kInfinity)) {
        return false;
    }
    bounds = {desc.maximum, kInfinity};
    end = ClearanceEnd::Beyond;
    return true;
}

SearchGoal goalOf(const ClearanceDesc& desc) {
    return {.tolerance = desc.tolerance,
            .maximum = desc.maximum,
            .finest = desc.tolerance / 4,
            .mostSteps = desc.mostSteps};
}

void measurePair(const PairAt& at, const ClearanceDesc& desc, ThreadMemory& memory, PairClearance& out) {
    CertifiedTally touch;
    if (touches(at, touch, out)) {
        return;
    }
    const Found found = at.search(memory, goalOf(desc));
    out.bounds = {touch.undecided ? 0 : found.lo, found.hi};
    if (isBeyond(desc, out.bounds, out.end)) {
        return;
    }
    out.end = endOf(out.bounds, found, desc.tolerance);
    if (found.hi < kInfinity) {
        out.closest = closestOf(found, memory.mesh, at.part.space);
    }
}

void measureLabel(const PairAt& at, const SearchedPart& searched, const ClearanceDesc& desc, ThreadMemory& memory,
                  LabelClearance& out) {
    const Found found = at.search(memory, searched, goalOf(desc));
    out.bounds = {found.lo, found.hi};
    if (!isBeyond(desc, out.bounds, out.end)) {
        out.end = endOf(out.bounds, found, desc.tolerance);
    }
}

void decideMargin(const PairAt& at, double margin, const ClearanceDesc& desc, ThreadMemory& memory, PairAnswer& out) {
    // What touches is within every margin, and that is soon known.
    std::optional<TouchPoint> point;
    const CertifiedTally touch = at.touch(point);
    bool hit = touch.certain > 0;
    bool possible = !hit && touch.undecided;
    if (!hit && margin > 0) {
        const Found found = at.search(memory, {.tolerance = 0,
                                               .maximum = std::nextafter(margin, kInfinity),
                                               .enough = margin,
                                               .finest = kDefaultTolerance / 4,
                                               .mostSteps = desc.mostSteps});
        hit = found.hi <= margin;
        possible = !hit && (touch.undecided || found.lo <= margin);
    }
    out = yesOrNo(out, hit, possible);
}

/// Each once, however often it is asked for; numbers of labels that the map does not have are left out.
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

/// Refuses what checkLabels() refuses.
Result<LabelSets> setsOf(ClearanceMeterImpl& impl, const BatchItem& item, const std::shared_ptr<const OpaquePart>& part,
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

} // namespace

ClearanceMeter::ClearanceMeter(std::unique_ptr<ClearanceMeterImpl> impl) noexcept : impl_(std::move(impl)) {}
ClearanceMeter::ClearanceMeter(ClearanceMeter&&) noexcept = default;
ClearanceMeter& ClearanceMeter::operator=(ClearanceMeter&&) noexcept = default;
ClearanceMeter::~ClearanceMeter() = default;

Result<ClearanceMeter> ClearanceMeter::create(const ClearanceDesc& desc) {
    return guard([&]() -> Result<ClearanceMeter> {
        VOXTACT_TRY(checkDesc(desc));
        return ClearanceMeter(std::make_unique<ClearanceMeterImpl>(desc));
    });
}

Result<ClearanceAnswer> ClearanceMeter::measure(const Batch& batch) {
    return guard([&]() -> Result<ClearanceAnswer> {
        const StopWatch watch;
        VOXTACT_TRY(checkCertifiedBatch(batch));
        const Cancellation cancel(batch.cancel);
        VOXTACT_TRY(checkNotCancelled(cancel));
        ClearanceAnswer answer;
        answer.pairs = numberedPairs<PairClearance>(batch);
        Workers& workers = impl_->workers;
        VOXTACT_TRY(workers.forEachPair(batch, cancel, workers.partsOf(batch, impl_->desc.resolution), answer.pairs,
                                        [&](const PairAt& at, PairClearance& pair, ThreadMemory& memory) {
                                            measurePair(at, impl_->desc, memory, pair);
                                        }));
        answer.wallMilliseconds = watch.milliseconds();
        return answer;
    });
}

Result<BatchAnswer> ClearanceMeter::within(const Batch& batch, double margin) {
    return guard([&]() -> Result<BatchAnswer> {
        const StopWatch watch;
        VOXTACT_TRY(checkCertifiedBatch(batch));
        if (!(margin >= 0 && margin < kInfinity)) {
            return refuse("the margin " + number(margin) + " mm is not a number from 0 on");
        }
        const Cancellation cancel(batch.cancel);
        VOXTACT_TRY(checkNotCancelled(cancel));
        BatchAnswer answer;
        answer.pairs = numberedPairs<PairAnswer>(batch);
        Workers& workers = impl_->workers;
        VOXTACT_TRY(workers.forEachPair(batch, cancel, workers.partsOf(batch, impl_->desc.resolution), answer.pairs,
                                        [&](const PairAt& at, PairAnswer& pair, ThreadMemory& memory) {
                                            decideMargin(at, margin, impl_->desc, memory, pair);
                                        }));
        answer.wallMilliseconds = watch.milliseconds();
        return answer;
    });
}

Result<LabelClearanceAnswer> ClearanceMeter::measureLabels(const Batch& batch, std::span<const std::int32_t> labels) {
    return guard([&]() -> Result<LabelClearanceAnswer> {
        const StopWatch watch;
        VOXTACT_TRY(checkCertifiedBatch(batch));
        VOXTACT_TRY(checkMeasuredLabels(batch, labels));
        const Cancellation cancel(batch.cancel);
        VOXTACT_TRY(checkNotCancelled(cancel));
        const Parts parts = impl_->desc.labelsAtAnyOpacity ? impl_->workers.wholesOf(batch)
                                                           : impl_->workers.partsOf(batch, impl_->desc.resolution);
        std::vector<std::vector<std::uint32_t>> indices;
        std::vector<LabelSets> sets;
        std::map<const LabelData*, std::uint64_t> fingerprints; // each of the call's maps is read once
        for (std::size_t i = 0; i < batch.items.size(); ++i) {
            const BatchItem& item = batch.items[i];
            const auto [print, isNew] = fingerprints.try_emplace(item.labels);
            print->second = isNew ? labelFingerprint(*item.labels) : print->second;
            indices.push_back(indicesOf(*item.labels, labels));
            Result<LabelSets> made = setsOf(*impl_, item, parts[i], print->second, indices[i]);
            VOXTACT_TRY(made);
            sets.push_back(std::move(*made));
        }
        LabelClearanceAnswer answer;
        answer.labels = numberedPairs<LabelClearance>(batch, labels.size());
        for (std::size_t i = 0; i < answer.labels.size(); ++i) {
            answer.labels[i].label = labels[i % labels.size()];
            answer.labels[i].bounds = {kInfinity, kInfinity};
        }
        VOXTACT_TRY(impl_->workers.forEachPair(batch, cancel, parts, answer.labels,
                                               [&](const PairAt& at, LabelClearance& label, ThreadMemory& memory) {
                                                   const LabelData& map = *at.item.labels;
                                                   const std::vector<std::uint32_t>& known = indices[label.item];
                                                   for (std::size_t i = 0; i < known.size(); ++i) {
                                                       if (map.values[known[i]] == label.label) {
                                                           const SearchedPart searched((*sets[label.item])[i], map);
                                                           measureLabel(at, searched, impl_->desc, memory, label);
                                                           return;
                                                       }
                                                   }
                                               }));
        answer.wallMilliseconds = watch.milliseconds();
        return answer;
    });
}

std::uint32_t ClearanceMeter::threads() const noexcept {
    return impl_->workers.threads();
}

} // namespace voxtact::cpu
