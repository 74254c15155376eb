// SPDX-License-Identifier: MIT
#pragma once

#include "exact/contact.h"
#include "host/pair_job.h"
#include "voxtact/cpu.h"

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace voxtact::cpu {

/// Refuses outputs that the host engine cannot do, and a maximal depth that is not a positive number.
[[nodiscard]] Result<void> checkOutputs(const Count& desc);
/// Refuses a missing label map if labels are requested, and an invalid one.
[[nodiscard]] Result<void> checkLabelMaps(const Batch& batch, const Outputs& outputs);

/// The outputs in addition to the counts of one batch, in the arithmetic of exact.h and contact.h. Threads share the
/// pairs, and the triangles of a pair.
class OutputRun {
  public:
    class Sink;

    OutputRun(const Batch& batch, const Count& desc, std::uint32_t pairs, std::uint32_t threads);
    ~OutputRun();

    /// Counts the passing fragments of the job's clusters one by one, with their outputs. No two concurrent calls with
    /// the same thread, or with the same cluster of a pair.
    std::uint64_t collect(const PairJob& job, std::size_t item, std::uint32_t pair, std::uint32_t thread);
    /// Calls `body` with a Sink for passing fragments of a pair that the caller finds. Like collect().
    void collect(std::size_t item, std::uint32_t pair, std::uint32_t thread, const std::function<void(Sink&)>& body);
    /// Once all threads are done.
    void finish(BatchAnswer& answer);

  private:
    struct Found;
    /// Data that all pairs of an item share.
    struct ItemOutputs {
        shader::OutputPair pair;
        const LabelData* labels;
        const StoredImage* image;
        const std::vector<float>* table;
    };

    Outputs outputs_;
    std::uint32_t mostContacts_;
    std::uint32_t pairs_;
    std::vector<ItemOutputs> items_;
    std::vector<std::unique_ptr<Found>> found_; ///< by thread
    std::atomic<std::uint64_t> contacts_{0};
};

/// Takes the outputs of passing fragments of one pair; one per thread.
class OutputRun::Sink {
  public:
    Sink(OutputRun& run, std::size_t item, std::uint32_t pair, std::uint32_t thread);

    /// Texture space; in the domain, unless coordinates are clamped. `known`: the contact's data at its position; null:
    /// samples them.
    void add(std::uint32_t triangle, const shader::ContactVector& at,
             const std::optional<shader::ContactSample>& known = {});
    /// Once all were added.
    void publish();

  private:
    void addContact(const shader::ContactVector& at, const Vec3& position, std::uint32_t triangle, std::uint32_t label,
                    const shader::ContactSample& sample);

    OutputRun& run_;
    const ItemOutputs& item_;
    std::uint32_t pair_;
    Found& found_;
};

} // namespace voxtact::cpu
