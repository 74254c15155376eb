// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/frame/stage.h"

namespace voxtact::view {

/// Files to read, and objects to create for the window.
struct LoadTask {
    std::function<Result<Given>(Progress&)> read; ///< called on the loader's thread
    std::optional<FileKind> opened;               ///< file opened in addition; empty: replaces everything
    std::uint32_t maxSide = 0;                    ///< voxels along a side that are shown; 0: what the device takes
    StageDesc stage;
};

/// A State and its stage.
struct Loaded {
    std::unique_ptr<State> state;
    std::unique_ptr<Stage> stage;
    std::optional<FileKind> opened;
};

struct LoadFailure {
    Error error; ///< Cancelled: not reported
    std::optional<FileKind> opened;
    /// If only the volume is too large for the device: the data that were read, and how much coarser the volume may
    /// fit.
    std::unique_ptr<Given> tooLarge;
    std::uint32_t coarser = 1;
};

/// Reads files and creates stages on its own thread, one at a time; of several tasks, only the last is done.
/// Thread-safety: none, apart from its own thread.
class Loader {
  public:
    /// `wake`: called from the loader's thread when a result is available. The session must outlive it.
    Loader(const device::Session& session, std::function<void()> wake);
    Loader(const Loader&) = delete;
    Loader& operator=(const Loader&) = delete;
    /// Cancels, and waits for the rest.
    ~Loader();

    /// Starts a task; replaces a pending one.
    void start(LoadTask task);
    /// Cancels the task.
    void cancel();
    /// Returns null without a task.
    [[nodiscard]] const Progress* progress() const { return progress_.get(); }
    /// Returns the result of the task, once.
    [[nodiscard]] std::optional<std::variant<Loaded, LoadFailure>> take();
    /// Destroys a stage that no frame uses, on the loader's thread, because it may wait.
    void discard(std::unique_ptr<Stage> stage);
    /// Calls a function on the loader's thread after the current task. It must not throw.
    void run(std::function<void()> work);

  private:
    struct Job {
        LoadTask task;
        std::shared_ptr<Progress> progress;
    };
    using Outcome = std::variant<Loaded, LoadFailure>;
    void work();
    [[nodiscard]] Outcome done(const Job& job) const;

    const device::Session* session_;
    std::function<void()> wake_;
    std::shared_ptr<Progress> progress_; ///< of the task whose outcome is waited for

    std::mutex mutex_;
    std::condition_variable asked_;
    std::optional<Job> job_;
    std::vector<std::function<void()>> chores_;
    std::optional<Outcome> outcome_;
    std::shared_ptr<Progress> outcomeOf_;
    bool stop_ = false;
    std::thread thread_;
};

} // namespace voxtact::view
