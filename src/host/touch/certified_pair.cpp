// SPDX-License-Identifier: MIT
#include "host/touch/certified_pair.h"
#include "host/touch/decider.h"

namespace voxtact::cpu {

namespace {
struct Any {
    static constexpr bool kCounts = false;
};
} // namespace

CertifiedTally decide(const CertifiedJob& job, const CertifiedSink& sink) {
    if (job.occupancy.nothingOpaque()) {
        return {};
    }
    if (!sink && !job.stopAtFirst) {
        return countCertain(job);
    }
    return job.volume.image.visit(
        [&]<class Kept>(const Kept* voxels) { return Decider<Kept, Any>(job, voxels, sink).run(); });
}

} // namespace voxtact::cpu
