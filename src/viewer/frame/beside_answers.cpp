// SPDX-License-Identifier: MIT
#include "viewer/frame/beside_answers.h"

#include "core/base/guard.h"
#include "core/base/try.h"

namespace voxtact::view {

Result<std::unique_ptr<BesideAnswers>> BesideAnswers::create(const device::Session& session, DeviceScene& scene,
                                                             std::shared_ptr<Detectors> detectors,
                                                             std::function<void()> wake) {
    DeviceAnswers answers(session, scene, detectors);
    Result<device::TimedSubmission> submission = device::TimedSubmission::create(session);
    VOXTACT_TRY(submission);
    return std::unique_ptr<BesideAnswers>(
        new BesideAnswers(scene, std::move(detectors), std::move(answers), std::move(*submission), std::move(wake)));
}

BesideAnswers::BesideAnswers(DeviceScene& scene, std::shared_ptr<Detectors> detectors, DeviceAnswers answers,
                             device::TimedSubmission submission, std::function<void()> wake)
    : scene_(&scene), detectors_(std::move(detectors)), answers_(std::move(answers)),
      submission_(std::move(submission)), wake_(std::move(wake)), thread_([this] { work(); }) {}

BesideAnswers::~BesideAnswers() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    asked_.notify_one();
    thread_.join();
}

void BesideAnswers::ask(LiveQuestion question) {
    busy_ = true;
    {
        const std::lock_guard lock(mutex_);
        question_ = std::move(question);
    }
    asked_.notify_one();
}

std::optional<Result<LiveAnswer>> BesideAnswers::take() {
    const std::lock_guard lock(mutex_);
    busy_ = busy_ && !answer_;
    return std::exchange(answer_, std::nullopt);
}

void BesideAnswers::work() {
    while (true) {
        LiveQuestion question;
        {
            std::unique_lock lock(mutex_);
            asked_.wait(lock, [this] { return stop_ || question_; });
            if (stop_) {
                return;
            }
            question = *std::exchange(question_, std::nullopt);
        }
        Result<LiveAnswer> found = guard([&] { return answer(question); });
        const std::lock_guard lock(mutex_);
        answer_ = std::move(found);
        if (!stop_) {
            wake_();
        }
    }
}

Result<LiveAnswer> BesideAnswers::answer(const LiveQuestion& question) {
    const bool first = detectors_->find(question.method) == nullptr;
    VOXTACT_TRY(detectors_->get(question.method)); // slow, so not under the lock
    Result<LiveAnswer> found = submit(question);
    // Drivers compile at first use, which is excluded from the answer's time.
    return first && found.ok() ? submit(question) : found;
}

Result<LiveAnswer> BesideAnswers::submit(const LiveQuestion& question) {
    const Result<device::TimedSubmission::Times> times = submission_.run([&](VkCommandBuffer commands) {
        const std::lock_guard lock(scene_->recording());
        return answers_.record(commands, *scene_, question, 0);
    });
    if (!times.ok()) {
        static_cast<void>(answers_.collect(0, 0)); // discards the recorded questions
        return times.error();
    }
    return *answers_.collect(0, times->wallMilliseconds);
}

} // namespace voxtact::view
