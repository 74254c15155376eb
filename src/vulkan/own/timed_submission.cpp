// SPDX-License-Identifier: MIT
#include "vulkan/own/timed_submission.h"

#include "core/base/try.h"

#include <chrono>

namespace voxtact::device {

namespace {

using Clock = std::chrono::steady_clock;

} // namespace

Result<void> TimedSubmission::submit(const std::function<Result<void>(VkCommandBuffer)>& record) {
    const Result<VkCommandBuffer> begun = commands_.begin();
    VOXTACT_TRY(begun);
    commands_.cmdStamp(0);
    VOXTACT_TRY(record(*begun));
    commands_.cmdStamp(1);
    VOXTACT_TRY(commands_.end());
    VOXTACT_TRY(commands_.submit());
    return commands_.wait();
}

Result<TimedSubmission> TimedSubmission::create(const Session& session) {
    Result<TimedCommands> commands = TimedCommands::create(session, 2);
    VOXTACT_TRY(commands);
    return TimedSubmission(std::move(*commands));
}

Result<TimedSubmission::Times> TimedSubmission::run(const std::function<Result<void>(VkCommandBuffer)>& record) {
    const auto begun = Clock::now();
    if (const Result<void> done = submit(record); !done.ok()) {
        commands_.waitForAll();
        return done.error();
    }
    Times times;
    times.wallMilliseconds = std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
    const Result<std::optional<double>> gpu = commands_.between(0, 1);
    VOXTACT_TRY(gpu);
    times.gpuMilliseconds = *gpu;
    return times;
}

} // namespace voxtact::device
