// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/own/timed_commands.h"

#include <functional>
#include <optional>

namespace voxtact::device {

/// Commands that are recorded, submitted and waited for, timed by both clocks.
/// Thread-safety: none; one thread at a time.
class TimedSubmission {
  public:
    struct Times {
        double wallMilliseconds = 0;           ///< from the start of recording to the end of the wait
        std::optional<double> gpuMilliseconds; ///< of the commands; nothing where the queue has no timestamps
    };

    /// The session must outlive it.
    [[nodiscard]] static Result<TimedSubmission> create(const Session& session);
    /// `record` records outside a render pass. Nothing is in flight afterwards, not after an error either.
    [[nodiscard]] Result<Times> run(const std::function<Result<void>(VkCommandBuffer)>& record);

  private:
    explicit TimedSubmission(TimedCommands commands) noexcept : commands_(std::move(commands)) {}
    Result<void> submit(const std::function<Result<void>(VkCommandBuffer)>& record);

    TimedCommands commands_;
};

} // namespace voxtact::device
