// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace voxtact::app {

/// Shows progress and remaining time on standard error: on a terminal a bar, after half a second, erased at the end;
/// elsewhere one line per minute.
class Progress {
  public:
    /// `wanted` false: shows nothing. `total` 0: unknown.
    Progress(bool wanted, std::string title, std::uint64_t total);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress();

    void update(std::uint64_t done);
    /// Sets the current activity; shown with the next update.
    void doing(const std::string& what) { doing_ = what + ", "; }

  private:
    using Clock = std::chrono::steady_clock;

    void drawBar(std::uint64_t done, const std::string& rest);

    bool wanted_;
    bool terminal_;
    std::string title_;
    std::string doing_;
    std::uint64_t total_;
    std::size_t lineLength_ = 0;
    Clock::time_point begun_;
    Clock::time_point next_;
};

/// Formats a duration, as precisely as estimates are: "45 s", "3 min", "1 h 20 min".
[[nodiscard]] std::string roughly(double seconds);
/// "1,234,567"
[[nodiscard]] std::string withCommas(std::uint64_t number);
/// Returns ", about 3 min left"; empty if unknown.
[[nodiscard]] std::string timeLeft(std::uint64_t done, std::uint64_t total, double secondsSoFar);

} // namespace voxtact::app
