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

/// Whether a signal came; from any thread.
[[nodiscard]] bool interrupted() noexcept;
/// The same, for calls that take a flag.
[[nodiscard]] const std::atomic<bool>& interruptFlag() noexcept;

/// Exit status 128 and the signal's number, as a shell has it, and "interrupted by SIGINT: " with what became of it.
[[nodiscard]] Outcome interruptOutcome(const std::string& what);

} // namespace voxtact::app
