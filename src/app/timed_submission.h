// SPDX-License-Identifier: MIT
#pragma once

#include "app/session.h"

#include <functional>
#include <memory>
#include <optional>

namespace voxtact::app {

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
    TimedSubmission(TimedSubmission&&) noexcept;
    TimedSubmission& operator=(TimedSubmission&&) noexcept;
    ~TimedSubmission();

    /// `record` records outside a render pass. Nothing is in flight afterwards, not after an error either.
    [[nodiscard]] Result<Times> run(const std::function<Result<void>(VkCommandBuffer)>& record);

    struct State;

  private:
    explicit TimedSubmission(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

} // namespace voxtact::app
