// SPDX-License-Identifier: MIT
#include "app/timed_submission.h"

#include "app/timed_commands.h"

#include <chrono>

namespace voxtact::app {

namespace {

using Clock = std::chrono::steady_clock;

} // namespace

struct TimedSubmission::State {
    TimedCommands commands;

    Result<void> submit(const std::function<Result<void>(VkCommandBuffer)>& record);
};

Result<void> TimedSubmission::State::submit(const std::function<Result<void>(VkCommandBuffer)>& record) {
    const Result<VkCommandBuffer> begun = commands.begin();
    if (!begun.ok()) {
        return begun.error();
    }
    commands.cmdStamp(0);
    if (Result<void> recorded = record(*begun); !recorded.ok()) {
        return recorded;
    }
    commands.cmdStamp(1);
    if (Result<void> ended = commands.end(); !ended.ok()) {
        return ended;
    }
    if (Result<void> submitted = commands.submit(); !submitted.ok()) {
        return submitted;
    }
    return commands.wait();
}

TimedSubmission::TimedSubmission(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
TimedSubmission::TimedSubmission(TimedSubmission&&) noexcept = default;
TimedSubmission& TimedSubmission::operator=(TimedSubmission&&) noexcept = default;
TimedSubmission::~TimedSubmission() = default;

Result<TimedSubmission> TimedSubmission::create(const Session& session) {
    Result<TimedCommands> commands = TimedCommands::create(session, 2);
    if (!commands.ok()) {
        return commands.error();
    }
    return TimedSubmission(std::unique_ptr<State>(new State{.commands = std::move(*commands)}));
}

Result<TimedSubmission::Times> TimedSubmission::run(const std::function<Result<void>(VkCommandBuffer)>& record) {
    const auto begun = Clock::now();
    if (const Result<void> done = state_->submit(record); !done.ok()) {
        state_->commands.waitForAll();
        return done.error();
    }
    Times times;
    times.wallMilliseconds = std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
    const Result<std::optional<double>> gpu = state_->commands.between(0, 1);
    if (!gpu.ok()) {
        return gpu.error();
    }
    times.gpuMilliseconds = *gpu;
    return times;
}

} // namespace voxtact::app
