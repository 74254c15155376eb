// SPDX-License-Identifier: MIT
#pragma once

#include "cli/output/outcome.h"

#include <atomic>

namespace voxtact::app {

/// Records the first SIGINT, SIGTERM or SIGHUP (unless ignored), so that the work can stop cleanly; a second signal
/// ends the program at once. Only one guard may exist at a time.
class InterruptGuard {
  public:
    InterruptGuard() noexcept;
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
    ~InterruptGuard();
};

/// Returns true after a signal; from any thread.
[[nodiscard]] bool interrupted() noexcept;
/// Returns the flag behind interrupted(), for calls with a cancel flag.
[[nodiscard]] const std::atomic<bool>& interruptFlag() noexcept;

/// Returns exit status 128 plus the signal number, like a shell, and "interrupted by SIGINT: " with `what`.
[[nodiscard]] Outcome interruptOutcome(const std::string& what);

} // namespace voxtact::app
