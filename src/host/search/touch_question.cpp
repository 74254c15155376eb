// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "core/geometry/glm_bridge.h"
#include "host/batch_check.h"
#include "host/host_engine.h"
#include "host/overlap/enclosed.h"
#include "host/search/opaque_next_to.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

Result<void> checkTouch(const Touch& question) {
    VOXTACT_TRY(checkFact(factOf("touch", "margin"), question.margin));
    if (question.uncertainty && question.margin > 0) {
        return refuse("a margin and an uncertain pose are two questions; leave out one of the two");
    }
    if (question.uncertainty) {
        VOXTACT_TRY(checkFact(factOf("touch", "uncertainty_distance"), question.uncertainty->distance));
        VOXTACT_TRY(checkFact(factOf("touch", "uncertainty_angle"), question.uncertainty->angle));
    }
    VOXTACT_TRY(checkSteps(question.maxSteps));
    return checkFact(factOf("count", "resolution"), question.resolution);
}

bool isCurved(const Batch& batch) {
    return std::ranges::any_of(batch.items,
                               [](const BatchItem& item) { return item.mesh->impl().facts.deflection > 0; });
}

/// A touch is within every margin, and fast to find. *No* includes the surface that the triangles represent; *yes* is
/// about the triangles.
void decide(const PairAt& at, const Touch& question, ThreadMemory& memory, PairTouch& out) {
    std::optional<TouchPoint> point;
    const CertifiedTally touch = at.touch(point);
    out.touch = touch.certain > 0 ? Verdict::Yes : touch.undecided ? Verdict::Undecided : Verdict::No;
    if (out.touch == Verdict::Yes) {
        if (question.witness && point) {
            out.witness = {opaqueNextTo(at, point->position), point->triangle};
        }
        return;
    }
    const double reach = question.margin + at.deflection();
    if (reach == 0) {
        return;
    }
    const Found found = at.search(memory, {.tolerance = 0,
                                           .maximum = std::nextafter(reach, kInfinity),
                                           .enough = question.margin > 0 ? question.margin : reach,
                                           .finest = kDefaultTolerance / 4,
                                           .maxSteps = question.maxSteps});
    if (found.hi <= question.margin) {
        out.touch = Verdict::Yes;
        if (question.witness) {
            out.witness = {fromGlm(found.inVolume + at.part.space.middle), memory.mesh.mesh().numbers[found.triangle]};
        }
    } else if (found.lo <= reach) {
        out.touch = Verdict::Undecided;
    }
}

Result<TouchAnswer> touchPairs(HostEngineImpl& impl, const Touch& question, const Batch& batch) {
    const Cancellation cancel(batch.cancel);
    VOXTACT_TRY(checkNotCancelled(cancel));
    TouchAnswer answer;
    answer.pairs = numberedPairs<PairTouch>(batch);
    Workers& workers = impl.workers;
    VOXTACT_TRY(workers.forEachPair(
        batch, cancel, workers.partsOf(batch, question.resolution), answer.pairs,
        [&](const PairAt& at, PairTouch& pair, ThreadMemory& memory) { decide(at, question, memory, pair); }));
    return answer;
}

/// The fastest way, which several threads may go for one pair.
Result<TouchAnswer> touchWithoutWitness(HostEngineImpl& impl, const Touch& question, const Batch& batch) {
    const Cancellation cancel(batch.cancel);
    VOXTACT_TRY(checkNotCancelled(cancel));
    TouchAnswer answer;
    answer.pairs = numberedPairs<PairTouch>(batch);
    const Count count{.projection = Projection::Certified, .stopAtFirst = true, .resolution = question.resolution};
    const BatchAnswer counted = runCertified(batch, cancel, static_cast<std::uint32_t>(answer.pairs.size()), count,
                                             impl.workers.pool(), impl.certified);
    VOXTACT_TRY(checkNotCancelled(cancel));
    for (std::size_t i = 0; i < answer.pairs.size(); ++i) {
        const PairAnswer& pair = counted.pairs[i];
        answer.pairs[i].touch = pair.hit ? Verdict::Yes : pair.possible ? Verdict::Undecided : Verdict::No;
    }
    return answer;
}

} // namespace

Result<TouchAnswer> HostEngine::ask(const Touch& question, const Batch& batch) {
    return guard([&]() -> Result<TouchAnswer> {
        const StopWatch watch;
        VOXTACT_TRY(checkTouch(question));
        VOXTACT_TRY(checkCertifiedBatch(batch));
        if (question.solid) {
            VOXTACT_TRY(checkSolids(*impl_, batch));
        }
        Result<TouchAnswer> answer = question.uncertainty ? touchAround(*impl_, question, batch)
                                     : question.witness || question.margin > 0 || isCurved(batch)
                                         ? touchPairs(*impl_, question, batch)
                                         : touchWithoutWitness(*impl_, question, batch);
        if (answer.ok() && question.solid) {
            VOXTACT_TRY(forEnclosed(
                *impl_, batch, answer->pairs, [](const PairTouch& pair) { return pair.touch != Verdict::Yes; },
                [&](PairTouch& pair, const Enclosed& enclosed) {
                    pair.touch = enclosed.verdict == Verdict::No ? pair.touch : enclosed.verdict;
                    if (question.witness && !question.uncertainty && enclosed.point) {
                        pair.witness = {*enclosed.point, kInsideMesh};
                    }
                }));
        }
        if (answer.ok()) {
            answer->wallMilliseconds = watch.milliseconds();
        }
        return answer;
    });
}

} // namespace voxtact::cpu
