// SPDX-License-Identifier: MIT
#pragma once

#include "host/count/occupancy_cache.h"
#include "host/search/pair_at.h"
#include "host/thread_pool.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

namespace voxtact::cpu {

/// Opaque regions of a batch's items.
using Parts = std::vector<std::shared_ptr<const OpaquePart>>;

/// Threads, and state kept between calls. One call at a time.
class Workers {
  public:
    /// 0: one for each processor.
    explicit Workers(std::uint32_t threads)
        : pool_(threads == 0 ? std::max(std::thread::hardware_concurrency(), 1U) : threads),
          memories_(pool_.threads()) {}

    [[nodiscard]] std::uint32_t threads() const noexcept { return pool_.threads(); }
    [[nodiscard]] ThreadPool& pool() noexcept { return pool_; }

    [[nodiscard]] std::shared_ptr<const OpaquePart> part(const VolumeImpl& volume, const TransferFunctionImpl& function,
                                                         double threshold, double resolution = kDefaultResolution) {
        return parts_.get(volume, function, threshold, resolution);
    }
    /// Returns the whole volume as a region, for any values.
    [[nodiscard]] std::shared_ptr<const OpaquePart> whole(const VolumeImpl& volume) {
        return parts_.get(volume, allOpaque_, kDefaultThreshold, kDefaultResolution);
    }
    [[nodiscard]] Parts partsOf(const Batch& batch, double resolution) {
        Parts parts;
        for (const BatchItem& item : batch.items) {
            parts.push_back(part(item.volume->impl(), item.transferFunction->impl(), batch.threshold, resolution));
        }
        return parts;
    }

    /// Returns whole volumes as regions, under transfer functions that make every value opaque.
    [[nodiscard]] Parts wholesOf(const Batch& batch) {
        Parts parts;
        for (const BatchItem& item : batch.items) {
            parts.push_back(whole(item.volume->impl()));
        }
        return parts;
    }

    /// Calls `fill(answer, memory)` for each answer, one at a time per thread. Rethrows its exceptions when all threads
    /// have stopped. Refuses cancelled calls.
    template <class Answer, class Fill>
    [[nodiscard]] Result<void> forEach(std::vector<Answer>& answers, const Cancellation& cancel, const Fill& fill) {
        if (answers.empty()) {
            return {};
        }
        std::atomic<std::size_t> next{0};
        pool_.run(answers.size(), [&](std::uint32_t thread) {
            const std::size_t i = next++;
            const bool some = i < answers.size() && !cancel.seen();
            if (some) {
                fill(answers[i], memories_[thread]);
            }
            return some;
        });
        return checkNotCancelled(cancel);
    }
    /// Calls `fill(at, answer, memory)` for answers that have an item and a pose.
    template <class Answer, class Fill>
    [[nodiscard]] Result<void> forEachPair(const Batch& batch, const Cancellation& cancel, const Parts& parts,
                                           std::vector<Answer>& answers, const Fill& fill) {
        return forEach(answers, cancel, [&](Answer& answer, ThreadMemory& memory) {
            const BatchItem& item = batch.items[answer.item];
            fill(PairAt{item, *parts[answer.item], item.world_from_object[answer.pose], &cancel}, answer, memory);
        });
    }

  private:
    ThreadPool pool_;
    std::vector<ThreadMemory> memories_;
    OccupancyCache<OpaquePart, 2> parts_;
    TransferFunctionImpl allOpaque_{.points = {{0, 1}}, .domain = {}, .table = {}};
};

/// `copies` entries for each pair, with the numbers of pair, item and pose.
template <class Answer> std::vector<Answer> numberedPairs(const Batch& batch, std::size_t copies = 1) {
    std::vector<Answer> answers;
    std::uint32_t pair = 0;
    for (std::uint32_t item = 0; item < batch.items.size(); ++item) {
        for (std::uint32_t pose = 0; pose < batch.items[item].world_from_object.size(); ++pose, ++pair) {
            Answer answer;
            answer.pair = pair;
            answer.item = item;
            answer.pose = pose;
            answers.insert(answers.end(), copies, answer);
        }
    }
    return answers;
}

/// Milliseconds since it was made.
class StopWatch {
  public:
    [[nodiscard]] double milliseconds() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace voxtact::cpu
