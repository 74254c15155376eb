// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

namespace voxtact::lab {

/// Wall clock since it was made.
class Stopwatch {
  public:
    [[nodiscard]] double milliseconds() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun_).count();
    }

  private:
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

} // namespace voxtact::lab
