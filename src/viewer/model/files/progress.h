// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <atomic>
#include <mutex>
#include <optional>
#include <string>

namespace voxtact::view {

/// Progress and cancellation of work on another thread. Thread-safety: safe from any thread.
class Progress {
  public:
    struct Now {
        std::string step;            ///< current step: "reading head.nii.gz"; empty before the first one
        std::optional<double> share; ///< share of the step, 0..1; empty if unknown
    };

    /// Begins a step. Returns Cancelled if the work was cancelled.
    [[nodiscard]] Result<void> begin(std::string step);
    /// Sets the share of the step, 0..1; returns false if cancelled.
    [[nodiscard]] bool tell(double share);
    [[nodiscard]] Now now() const;

    /// Cancels: the work ends at the next step or report.
    void cancel() { cancelled_ = true; }
    [[nodiscard]] bool cancelled() const { return cancelled_; }

  private:
    mutable std::mutex mutex_;
    Now now_;
    std::atomic<bool> cancelled_ = false;
};

} // namespace voxtact::view
