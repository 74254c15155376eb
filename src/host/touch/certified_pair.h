// SPDX-License-Identifier: MIT
#pragma once

#include "host/cancel.h"
#include "host/touch/cells/certified_occupancy.h"
#include "voxtact/data.h"

#include <cstdint>
#include <functional>

namespace voxtact::cpu {

/// One pair in the projection `certified`, or some of its clusters.
struct CertifiedJob {
    const MeshImpl& mesh;
    const VolumeImpl& volume;
    const CertifiedOccupancy& occupancy;
    shader::CertifiedPair transform;
    std::uint32_t clusterBegin;
    std::uint32_t clusterEnd;
    bool stopAtFirst; ///< the count is then 0 or 1
    CancelFlag cancel = nullptr;
};

struct CertifiedTally {
    std::uint64_t certain = 0; ///< fragments: a triangle in a cell
    bool undecided = false;    ///< at least one fragment could not be decided
};

/// Receives the triangle index and the witness of each certain fragment.
using CertifiedSink = std::function<void(std::uint32_t triangle, const shader::CertifiedProof& proof)>;

/// Visits the fragments of a job. `sink` may be empty. Culls clusters, triangles and bricks that provably have no
/// opaque point. Thread-safe.
[[nodiscard]] CertifiedTally decide(const CertifiedJob& job, const CertifiedSink& sink = {});

/// Like decide() without a sink, for a job without early exit: faster if much is entirely opaque. Expects a volume with
/// opaque values.
[[nodiscard]] CertifiedTally countCertain(const CertifiedJob& job);

} // namespace voxtact::cpu
