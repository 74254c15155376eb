// SPDX-License-Identifier: MIT
#include "voxtact/results.h"

#include <algorithm>

namespace voxtact {

PairAnswer unpack(const PairResult& result) noexcept {
    PairAnswer out;
    out.pair = result.pair;
    out.item = result.item;
    out.pose = result.pose;
    out.method = static_cast<CountingMethod>(VOXTACT_HOW_METHOD(result.how));
    out.projection = static_cast<Projection>(VOXTACT_HOW_PROJECTION(result.how));
    out.exactness = static_cast<Exactness>(VOXTACT_HOW_EXACTNESS(result.how));
    out.count = (std::uint64_t{result.countHigh} << 32) | result.countLow;
    out.hit = out.count > 0;
    if (out.exactness == Exactness::LowerBound && out.hit) {
        out.count = 1;
    }
    if (VOXTACT_HOW_UNDECIDED(result.how) != 0) {
        out.possible = !out.hit;
        out.exactness = out.exactness == Exactness::Refused ? Exactness::Refused : Exactness::LowerBound;
    }
    return out;
}

CertifiedCounters together(const CertifiedCounters& a, const CertifiedCounters& b) noexcept {
    using C = CertifiedCounters;
    C out = a;
    for (const auto total :
         {&C::clusters, &C::clustersKept, &C::runsKept, &C::largeParts, &C::bricksSeen, &C::cellsSeen, &C::cellsListed,
          &C::cellsCertain, &C::cellsDecided, &C::lanes, &C::cellsOpen, &C::left, &C::bricksLeft, &C::cellsLeft}) {
        out.*total += b.*total;
    }
    out.rounds += b.rounds;
    for (const auto peak : {&C::room, &C::peakClusters, &C::peakRuns, &C::peakParts, &C::peakCells, &C::peakOpen,
                            &C::peakLeft, &C::peakTests, &C::peakTestsLeft}) {
        out.*peak = std::max(out.*peak, b.*peak);
    }
    return out;
}

} // namespace voxtact
