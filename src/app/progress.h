// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace voxtact::app {

/// A bar on standard error for work that takes longer than half a second. It is wiped when it goes.
class Progress {
  public:
    /// `shown` false: does nothing.
    Progress(bool shown, std::string title, std::uint64_t total);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress();

    void update(std::uint64_t done);

  private:
    bool shown_;
    std::string title_;
    std::uint64_t total_;
    std::size_t lineLength_ = 0;
    std::chrono::steady_clock::time_point next_;
};

} // namespace voxtact::app
