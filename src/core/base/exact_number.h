// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace voxtact {

/// A sum or product of doubles without rounding, overflow or underflow: a whole number of any length times a power of
/// two. For the few decisions that double precision leaves open.
class ExactNumber {
  public:
    /// Expects a finite number.
    explicit ExactNumber(double value);

    /// -1, 0 or 1.
    [[nodiscard]] int sign() const noexcept { return words_.empty() ? 0 : (negative_ ? -1 : 1); }

    friend ExactNumber operator+(const ExactNumber& a, const ExactNumber& b);
    friend ExactNumber operator-(const ExactNumber& a, const ExactNumber& b);
    friend ExactNumber operator*(const ExactNumber& a, const ExactNumber& b);

  private:
    using Words = std::vector<std::uint32_t>;

    ExactNumber(bool negative, std::int64_t exponent, Words words);
    [[nodiscard]] Words wordsFrom(std::int64_t exponent) const;

    bool negative_ = false;
    std::int64_t exponent_ = 0; ///< the number is words_ * 2^(32 * exponent_)
    Words words_;               ///< the least first; neither the first nor the last is zero; none: zero
};

} // namespace voxtact
