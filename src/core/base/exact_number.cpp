// SPDX-License-Identifier: MIT
#include "core/base/exact_number.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

using Words = std::vector<std::uint32_t>;

constexpr int kWordBits = 32;

std::uint32_t low(std::uint64_t value) {
    return static_cast<std::uint32_t>(value);
}

std::uint32_t wordAt(const Words& words, std::size_t i) {
    return i < words.size() ? words[i] : 0;
}

/// -1, 0 or 1.
int compare(const Words& a, const Words& b) {
    for (std::size_t i = std::max(a.size(), b.size()); i-- > 0;) {
        if (wordAt(a, i) != wordAt(b, i)) {
            return wordAt(a, i) < wordAt(b, i) ? -1 : 1;
        }
    }
    return 0;
}

Words sum(const Words& a, const Words& b) {
    Words out(std::max(a.size(), b.size()) + 1);
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        carry += std::uint64_t{wordAt(a, i)} + wordAt(b, i);
        out[i] = low(carry);
        carry >>= kWordBits;
    }
    return out;
}

/// a - b, for a that is not less than b.
Words difference(const Words& a, const Words& b) {
    Words out(a.size());
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const std::uint64_t taken = std::uint64_t{wordAt(b, i)} + borrow;
        out[i] = low(a[i] - taken);
        borrow = a[i] < taken ? 1 : 0;
    }
    return out;
}

} // namespace

ExactNumber::ExactNumber(double value) {
    int exponent = 0;
    const double fraction = std::frexp(std::abs(value), &exponent);
    const auto mantissa = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
    exponent -= 53;
    // Rounded down, also below zero.
    const int shift = (exponent % kWordBits + kWordBits) % kWordBits;
    const std::uint64_t first = (mantissa & 0xffffffffU) << shift;
    const std::uint64_t second = ((mantissa >> kWordBits) << shift) + (first >> kWordBits);
    *this = ExactNumber(value < 0, (exponent - shift) / kWordBits, {low(first), low(second), low(second >> kWordBits)});
}

ExactNumber::ExactNumber(bool negative, std::int64_t exponent, Words words)
    : negative_(negative), exponent_(exponent), words_(std::move(words)) {
    while (!words_.empty() && words_.back() == 0) {
        words_.pop_back();
    }
    const auto first = std::find_if(words_.begin(), words_.end(), [](std::uint32_t word) { return word != 0; });
    exponent_ += first - words_.begin();
    words_.erase(words_.begin(), first);
}

/// The mantissa for an exponent that is at most this one's.
ExactNumber::Words ExactNumber::wordsFrom(std::int64_t exponent) const {
    Words out(static_cast<std::size_t>(exponent_ - exponent), 0);
    out.insert(out.end(), words_.begin(), words_.end());
    return out;
}

ExactNumber operator+(const ExactNumber& a, const ExactNumber& b) {
    if (a.sign() == 0 || b.sign() == 0) {
        return a.sign() == 0 ? b : a;
    }
    const std::int64_t exponent = std::min(a.exponent_, b.exponent_);
    const Words first = a.wordsFrom(exponent);
    const Words second = b.wordsFrom(exponent);
    if (a.negative_ == b.negative_) {
        return {a.negative_, exponent, sum(first, second)};
    }
    return compare(first, second) >= 0 ? ExactNumber(a.negative_, exponent, difference(first, second))
                                       : ExactNumber(b.negative_, exponent, difference(second, first));
}

ExactNumber operator-(const ExactNumber& a, const ExactNumber& b) {
    ExactNumber negated = b;
    negated.negative_ = !b.negative_;
    return a + negated;
}

ExactNumber operator*(const ExactNumber& a, const ExactNumber& b) {
    Words out(a.words_.size() + b.words_.size(), 0);
    for (std::size_t i = 0; i < a.words_.size(); ++i) {
        std::uint64_t carry = 0;
        for (std::size_t j = 0; j < b.words_.size() || carry != 0; ++j) {
            carry += std::uint64_t{a.words_[i]} * wordAt(b.words_, j) + out[i + j];
            out[i + j] = low(carry);
            carry >>= kWordBits;
        }
    }
    return {a.negative_ != b.negative_, a.exponent_ + b.exponent_, std::move(out)};
}

} // namespace voxtact
