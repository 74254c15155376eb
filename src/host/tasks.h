// SPDX-License-Identifier: MIT
#pragma once

#include "host/cancel.h"
#include "host/thread_pool.h"
#include "voxtact/cpu.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace voxtact::cpu {

/// Some clusters of one pair.
struct Task {
    std::uint32_t item = 0;
    std::uint32_t pose = 0;
    std::uint32_t pair = 0;
    std::uint32_t clusterBegin = 0;
    std::uint32_t clusterEnd = 0;
};

/// A batch cut into tasks that threads take one by one. The pairs are the tasks, cut further where there are fewer
/// than keep the threads busy.
class Tasks {
  public:
    /// Expects a batch that checkBatch() accepts, and its number of pairs.
    Tasks(const Batch& batch, const Cancellation& cancel, std::uint32_t pairs, std::uint32_t threads);

    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    [[nodiscard]] Task at(std::uint64_t task) const noexcept;
    /// Calls `body(task, thread)` for all tasks on the pool's threads, until cancelled. Rethrows an exception after all
    /// threads have stopped.
    void run(ThreadPool& pool, const std::function<void(const Task&, std::uint32_t thread)>& body) const;

  private:
    struct Item {
        std::uint32_t firstPair;
        std::uint32_t parts; ///< of each of its pairs
        std::uint32_t clusters;
        std::uint64_t firstTask;
    };
    std::vector<Item> items_;
    std::uint64_t count_ = 0;
    CancelFlag cancel_;
};

} // namespace voxtact::cpu
