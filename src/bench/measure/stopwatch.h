// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>

namespace voxtact::lab {

/// Wall clock since it was made.
class Stopwatch {
  public:
    /// 0 where the clock has gone backwards, which it must not.
    [[nodiscard]] double milliseconds() const {
        const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - begun_;
        return std::max(passed.count(), 0.0);
    }

  private:
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

} // namespace voxtact::lab
