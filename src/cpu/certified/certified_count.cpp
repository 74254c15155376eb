// SPDX-License-Identifier: MIT
#include "cpu/certified/certified_pair.h"
#include "cpu/certified/decider.h"

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
