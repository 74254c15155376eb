// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

namespace voxtact {

/// Chooses the size of the next piece: small at first, for early results, then about a tenth of a second.
class BatchPace {
  public:
    /// `fixed`: always `most`.
    BatchPace(std::uint32_t most, bool fixed) : most_(most), fixed_(fixed), size_(fixed ? most : std::min(most, 16U)) {}

    [[nodiscard]] std::uint32_t size() const noexcept { return size_; }
    /// Reports the duration of a piece of this size.
    void took(std::uint32_t done, double milliseconds) noexcept {
        constexpr double kShort = 50;
        constexpr double kLong = 200;
        if (fixed_ || done < size_) {
            return;
        }
        if (milliseconds < kShort) {
            size_ = size_ > most_ / 2 ? most_ : size_ * 2;
        } else if (milliseconds > kLong) {
            size_ = std::max(size_ / 2, 1U);
        }
    }

  private:
    std::uint32_t most_;
    bool fixed_;
    std::uint32_t size_;
};

} // namespace voxtact
