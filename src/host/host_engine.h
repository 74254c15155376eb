// SPDX-License-Identifier: MIT
#pragma once

#include "host/count/count_run.h"
#include "host/motion/divided_mesh.h"
#include "host/search/kept_labels.h"
#include "host/search/workers.h"
#include "host/touch/certified_run.h"

#include <map>
#include <memory>
#include <vector>

namespace voxtact::cpu {

struct OverlapMeterImpl;

/// State that an engine keeps between calls. The folder named after a question answers it.
struct HostEngineImpl {
    explicit HostEngineImpl(std::uint32_t threads) : workers(threads) {}

    Workers workers;
    std::vector<ScratchPointer> scratches; ///< of threads that count; empty before the first count
    Occupancies occupancies;
    CertifiedOccupancies certified;
    std::vector<KeptLabels> labels;            ///< of Distance
    std::shared_ptr<OverlapMeterImpl> overlap; ///< null before the first Overlap
    /// dividedMesh() of the meshes of the last batch with an uncertain angle, by MeshImpl::id.
    std::map<std::uint64_t, std::unique_ptr<MeshImpl>> divided;
};

/// Answers `Touch` with an uncertainty. Expects a batch that checkCertifiedBatch() accepts.
[[nodiscard]] Result<TouchAnswer> touchAround(HostEngineImpl& impl, const Touch& question, const Batch& batch);

/// Refuses a number of steps that no search does with.
[[nodiscard]] Result<void> checkSteps(std::uint64_t maxSteps);

} // namespace voxtact::cpu
