// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/fit_notes.h"
#include "cli/pairs/window_rows.h"
#include "core/base/try.h"

#include <algorithm>
#include <functional>
#include <map>

namespace voxtact::app {

/// Answers pairs, on the host or by a device method.
class PairEngine {
  public:
    PairEngine() = default;
    PairEngine(const PairEngine&) = delete;
    PairEngine& operator=(const PairEngine&) = delete;
    virtual ~PairEngine() = default;

    [[nodiscard]] virtual std::string device() const = 0;
    [[nodiscard]] virtual std::string driver() const = 0;
    /// Returns the answer for a pair that cannot touch.
    [[nodiscard]] virtual PairAnswer untouched() const = 0;
    /// Selects the volume of a job for answer(); returns its grid.
    [[nodiscard]] virtual Result<Grid> use(std::uint32_t job) = 0;
    /// Returns opaque voxels of the current volume.
    [[nodiscard]] virtual OpaqueVoxels opaque() const = 0;
    [[nodiscard]] virtual bool isResampled() const = 0;
    /// Answers the selected poses of the window, in order. Ends early without an error when `stop` returns true.
    [[nodiscard]] virtual Result<void> answer(const Window& window, WindowRows& rows,
                                              const std::function<bool()>& stop) = 0;
};

/// Returns the jobs of each volume, if consecutive: their pairs in the shard.
[[nodiscard]] std::vector<PairRange> volumeGroups(const PairOptions& options, const PairInputs& inputs);

/// Sends pairs to an engine.
class PairAsker {
  public:
    /// All arguments must outlive the object.
    PairAsker(const PairOptions& options, PairInputs& inputs, PairEngine& engine);

    /// Answers the pairs of a range. An interrupt ends it early without an error. Calls `progress` regularly.
    [[nodiscard]] Result<void> answer(const PairRange& range, PairOutput& output,
                                      const std::function<void()>& progress);
    /// Returns the engine's duration so far.
    [[nodiscard]] double milliseconds() const noexcept { return milliseconds_; }
    /// Adds notes on meshes and volumes that do not fit.
    void addTo(std::vector<std::string>& notes) const { fit_.addTo(notes); }

  private:
    [[nodiscard]] Result<void> answer(Window& window, const Grid& grid, PairOutput& output,
                                      const std::function<void()>& progress);

    const PairOptions& options_;
    PairInputs& inputs_;
    PairEngine& engine_;
    FitNotes fit_;
    double milliseconds_ = 0;
};

/// Answers all pairs of the jobs; an interrupt ends it early without an error. Returns the engine's duration,
/// milliseconds. Adds notes on meshes and volumes that do not fit to `notes`.
[[nodiscard]] Result<double> answerPairs(const PairOptions& options, PairInputs& inputs, PairEngine& engine,
                                         PairOutput& output, std::vector<std::string>& notes);

/// Calls `answer` with an engine on the session's device, or on the host (no Vulkan). Destroys the engine afterwards.
using UseEngine = std::function<Result<void>(PairEngine&)>;
[[nodiscard]] Result<void> withDeviceEngine(const PairOptions& options, const PairInputs& inputs,
                                            const device::Session& session, CountingMethod method,
                                            const UseEngine& answer);
[[nodiscard]] Result<void> withHostEngine(const PairOptions& options, const PairInputs& inputs,
                                          const UseEngine& answer);

/// Cache of prepared volumes: keeps a volume while a later job uses it and memory allows.
template <class Ready> class VolumeShelf {
  public:
    VolumeShelf(const PairJobs& jobs, std::uint64_t maxBytes) : jobs_(jobs), maxBytes_(maxBytes) {}

    /// Returns the volume of this job, created by `make` (Result<Ready>; Ready::bytes: its size) if it is not
    /// cached.
    template <class Make> Result<Ready*> get(std::uint32_t job, const Make& make) {
        const std::uint32_t volume = jobs_.jobs[job].volume;
        if (const auto found = ready_.find(volume); found != ready_.end()) {
            return &found->second;
        }
        std::erase_if(ready_, [&](const auto& entry) { return nextUse(entry.first, job) == kNever; });
        for (std::uint64_t bytes = bytesOf(); !ready_.empty() && bytes > maxBytes_; bytes = bytesOf()) {
            ready_.erase(std::max_element(ready_.begin(), ready_.end(), [&](const auto& a, const auto& b) {
                return nextUse(a.first, job) < nextUse(b.first, job);
            }));
        }
        Result<Ready> made = make();
        VOXTACT_TRY(made);
        return &ready_.emplace(volume, std::move(*made)).first->second;
    }

  private:
    static constexpr std::size_t kNever = SIZE_MAX;

    /// Returns the next job, from this one on, that uses the volume.
    [[nodiscard]] std::size_t nextUse(std::uint32_t volume, std::size_t job) const {
        while (job < jobs_.jobs.size() && jobs_.jobs[job].volume != volume) {
            ++job;
        }
        return job < jobs_.jobs.size() ? job : kNever;
    }
    [[nodiscard]] std::uint64_t bytesOf() const {
        std::uint64_t sum = 0;
        for (const auto& [volume, ready] : ready_) {
            sum += ready.bytes;
        }
        return sum;
    }

    const PairJobs& jobs_;
    std::uint64_t maxBytes_;
    std::map<std::uint32_t, Ready> ready_;
};

} // namespace voxtact::app
