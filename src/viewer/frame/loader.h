// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/frame/stage.h"

namespace voxtact::view {

/// Files to read, and objects to create for the window.
struct LoadTask {
    std::function<Result<Given>(Progress&)> read; ///< called on the loader's thread
    std::optional<FileKind> opened;               ///< file that was opened in addition; empty: everything is replaced
    std::uint32_t mostSide = 0;                   ///< voxels along a side that are shown; 0: what the device takes
    StageDesc stage;
};

/// A State and what it is drawn from.
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

/// Reads files and makes stages on a thread of its own, one at a time; of several tasks the last is done.
/// Thread-safety: none; its own thread apart, one thread at a time.
class Loader {
  public:
    /// `wake` is called from the loader's thread when something is to be taken. The session must outlive it.
    Loader(const device::Session& session, std::function<void()> wake);
    Loader(const Loader&) = delete;
    Loader& operator=(const Loader&) = delete;
    /// Cancels, and waits for what cannot be.
    ~Loader();

    /// Instead of the task before, if that is not done.
    void start(LoadTask task);
    /// Cancels the task.
    void cancel();
    /// Null while there is no task.
    [[nodiscard]] const Progress* progress() const { return progress_.get(); }
    /// Returns the result of the task, once.
    [[nodiscard]] std::optional<std::variant<Loaded, LoadFailure>> take();
    /// Ends a stage that no frame uses any more, on the loader's thread: that may wait.
    void discard(std::unique_ptr<Stage> stage);
    /// Calls it on the loader's thread, when the task that is being done is. It must not throw.
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
