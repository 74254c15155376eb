// SPDX-License-Identifier: MIT
#pragma once

#include "host/pair_job.h"

#include <cstdint>
#include <memory>

namespace voxtact::cpu {

/// The working memory of one thread.
struct Scratch;
struct ScratchDeleter {
    void operator()(Scratch* scratch) const noexcept;
};
using ScratchPointer = std::unique_ptr<Scratch, ScratchDeleter>;
[[nodiscard]] ScratchPointer makeScratch();

/// Returns the passing fragments of the job's clusters, with the best instructions of the processor. With stopAtFirst,
/// 1 for any.
[[nodiscard]] std::uint64_t countSurvivors(const PairJob& job, Scratch& scratch);

} // namespace voxtact::cpu
