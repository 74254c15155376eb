// SPDX-License-Identifier: MIT
#include "core/transfer/opaque_ranges.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

/// Covers a table kept as 16-bit floats (11 bits of mantissa) and the rounding of the device's interpolation.
constexpr double kOpacityMargin = 1e-3;

/// A scalar looks up the two entries around it; one more on each side covers weights of 8 fraction bits.
constexpr double kEntryMargin = 2.0;

/// Relative to the largest term of the normalisation: a product, a sum, and the filter before them.
constexpr double kNormalisationError = 8.0 / (1 << 24);

} // namespace

OpaqueRanges::OpaqueRanges(std::span<const float> table, const ValueRange& domain, double threshold, double largest)
    : domain_(domain), entryMargin_(kEntryMargin + kNormalisationError * static_cast<double>(table.size()) * largest /
                                                       (domain.hi - domain.lo)),
      opaqueBefore_(table.size() + 1, 0) {
    const double safe = threshold - kOpacityMargin;
    for (std::size_t i = 0; i < table.size(); ++i) {
        const auto opacity = static_cast<double>(table[i]);
        opaqueBefore_[i + 1] = opaqueBefore_[i] + (opacity >= safe ? 1U : 0U);
    }
}

double OpaqueRanges::entry(double value) const noexcept {
    const auto entries = static_cast<double>(opaqueBefore_.size() - 1);
    return (value - domain_.lo) / (domain_.hi - domain_.lo) * entries - 0.5;
}

OpaqueRanges::Entries OpaqueRanges::entries(const ValueRange& range) const noexcept {
    const auto last = static_cast<double>(opaqueBefore_.size() - 2);
    const double lo = std::clamp(std::floor(entry(range.lo) - entryMargin_), 0.0, last);
    const double hi = std::clamp(std::ceil(entry(range.hi) + entryMargin_), 0.0, last);
    return {static_cast<std::size_t>(lo), static_cast<std::size_t>(hi)};
}

bool OpaqueRanges::mayBeOpaque(const ValueRange& range) const noexcept {
    const Entries within = entries(range);
    return opaqueBefore_[within.last + 1] > opaqueBefore_[within.first];
}

} // namespace voxtact
