// SPDX-License-Identifier: MIT
#include "host/touch/certified_pair.h"
#include "host/touch/decider.h"

namespace voxtact::cpu {

namespace {
struct Counts {
    static constexpr bool kCounts = true;
};
} // namespace

CertifiedTally countCertain(const CertifiedJob& job) {
    const CertifiedSink none;
    return job.volume.image.visit(
        [&]<class Kept>(const Kept* voxels) { return Decider<Kept, Counts>(job, voxels, none).run(); });
}

} // namespace voxtact::cpu
