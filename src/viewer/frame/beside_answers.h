// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/frame/device_answers.h"
#include "vulkan/own/timed_submission.h"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <thread>

namespace voxtact::view {

/// Answers of the device on a separate thread with its own submissions, one at a time: no frame waits for the
/// compilation of a new method.
class BesideAnswers {
  public:
    /// The scene must outlive it. `wake`: called from its thread when there is an answer.
    [[nodiscard]] static Result<std::unique_ptr<BesideAnswers>> create(const device::Session& session,
                                                                       DeviceScene& scene,
                                                                       std::shared_ptr<Detectors> detectors,
                                                                       std::function<void()> wake);
    /// Waits for the pending answer.
    ~BesideAnswers();

    /// Returns true if a question is pending, or its answer was not taken.
    [[nodiscard]] bool busy() const { return busy_; }
    /// Only while it is not busy.
    void ask(LiveQuestion question);
    /// Returns the answer, once.
    [[nodiscard]] std::optional<Result<LiveAnswer>> take();

  private:
    BesideAnswers(DeviceScene& scene, std::shared_ptr<Detectors> detectors, DeviceAnswers answers,
                  device::TimedSubmission submission, std::function<void()> wake);
    void work();
    [[nodiscard]] Result<LiveAnswer> answer(const LiveQuestion& question);
    [[nodiscard]] Result<LiveAnswer> submit(const LiveQuestion& question);

    DeviceScene* scene_;
    std::shared_ptr<Detectors> detectors_;
    DeviceAnswers answers_;
    device::TimedSubmission submission_;
    std::function<void()> wake_;
    bool busy_ = false;

    std::mutex mutex_;
    std::condition_variable asked_;
    std::optional<LiveQuestion> question_;
    std::optional<Result<LiveAnswer>> answer_;
    bool stop_ = false;
    std::thread thread_;
};

} // namespace voxtact::view
