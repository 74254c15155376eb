// SPDX-License-Identifier: MIT
#pragma once

#include "contact.h"
#include "cpu/pair_job.h"
#include "voxtact/cpu.h"

#include <atomic>
#include <vector>

namespace voxtact::cpu {

/// Refuses outputs that the host engine cannot do, and a maximal depth that is not a positive number.
[[nodiscard]] Result<void> checkOutputs(const DetectorDesc& desc);
/// Refuses a label map that is not there where labels are asked for, or is none.
[[nodiscard]] Result<void> checkLabelMaps(const Batch& batch, const Outputs& outputs);

/// The outputs beside the counts of one batch: every fragment one after the other, in the arithmetic of exact.h and
/// contact.h. Threads share the pairs, and the triangles of a pair.
class OutputRun {
  public:
    OutputRun(const Batch& batch, const DetectorDesc& desc, std::uint32_t pairs, std::uint32_t threads);

    /// Survivors of the job's clusters, after whose outputs were taken. No two calls at a time with the same thread,
    /// nor two with the same cluster of a pair.
    std::uint64_t collect(const PairJob& job, std::size_t item, std::uint32_t pair, std::uint32_t thread) noexcept;
    /// Once all threads are done. Throws std::bad_alloc where one of them had no memory.
    void finish(BatchAnswer& answer);

  private:
    /// What one thread has found.
    struct Found {
        std::vector<TouchedTriangle> triangles;
        std::vector<Contact> contacts;
        std::vector<std::pair<std::uint32_t, Box>> boxes; ///< of parts of pairs
        std::vector<LabelCount> labels;                   ///< of parts of pairs
    };
    /// What is the same for all pairs of an item.
    struct ItemOutputs {
        shader::OutputPair pair;
        const LabelData* labels;
    };
    class Part;

    void mergeBoxes(BatchAnswer& answer) const;
    void mergeLabels(BatchAnswer& answer) const;

    Outputs outputs_;
    std::uint32_t mostContacts_;
    std::uint32_t pairs_;
    std::vector<ItemOutputs> items_;
    std::vector<Found> found_; ///< by thread
    std::atomic<std::uint64_t> contacts_{0};
    std::atomic<bool> outOfMemory_{false};
};

} // namespace voxtact::cpu
