// SPDX-License-Identifier: MIT
#pragma once

#include "cli/output/outcome.h"

#include <atomic>

namespace voxtact::app {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP (that is not ignored) is only noted, so that the work can stop
/// where nothing is half done; the second one ends the program at once. One at a time.
class InterruptGuard {
  public:
    InterruptGuard() noexcept;
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
    ~InterruptGuard();
};

/// Returns true after a signal; from any thread.
[[nodiscard]] bool interrupted() noexcept;
/// Returns the flag of interrupted(), for calls that take one.
[[nodiscard]] const std::atomic<bool>& interruptFlag() noexcept;

/// Returns exit status 128 plus the signal's number, like a shell, and "interrupted by SIGINT: " with the consequence.
[[nodiscard]] Outcome interruptOutcome(const std::string& what);

} // namespace voxtact::app
