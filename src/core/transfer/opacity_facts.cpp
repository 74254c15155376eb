// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "core/transfer/opaque_intervals.h"
#include "core/transfer/table_points.h"
#include "voxtact/data.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

/// Maximum distance of an interval's end within the data from the ends of other intervals.
double farthest(std::span<const ValueRange> from, std::span<const ValueRange> to, const ValueRange& data) {
    double most = 0;
    for (double ValueRange::*const end : {&ValueRange::lo, &ValueRange::hi}) {
        for (const ValueRange& one : from) {
            double least = one.*end < data.lo || one.*end > data.hi ? 0 : kInfinity;
            for (const ValueRange& other : to) {
                least = std::min(least, std::abs(one.*end - other.*end));
            }
            most = std::max(most, least);
        }
    }
    return most;
}

} // namespace

Result<OpacityFacts> checkOpacity(const TransferFunctionDesc& desc, const ValueRange& data, double threshold) {
    return guard([&]() -> Result<OpacityFacts> {
        const Result<std::vector<float>> table = sampleTable(desc);
        VOXTACT_TRY(table);
        VOXTACT_TRY(checkFact(factOf("scene", "opacity_threshold"), threshold));
        if (!(data.lo <= data.hi)) {
            return refuse("the data's values are from " + number(data.lo) + " to " + number(data.hi));
        }
        const OpaqueIntervals byPoints(desc.points, threshold);
        const OpaqueIntervals byTable(pointsOf(*table, tableDomain(desc)), static_cast<float>(threshold));
        OpacityFacts facts;
        facts.reaches = !byPoints.outer().empty();
        facts.any = byPoints.mayMeet(data.lo, data.hi);
        facts.moved = std::max(farthest(byPoints.outer(), byTable.outer(), data),
                               farthest(byTable.outer(), byPoints.outer(), data));
        return facts;
    });
}

} // namespace voxtact
