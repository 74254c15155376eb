// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace voxtact {

/// The largest magnitude, in the image's units, of a device's single-precision terms between a texel and the normalised
/// scalar. `intercept` and `texel`: of the line from a stored texel to a value.
[[nodiscard]] inline double largestTerm(double intercept, double texel, const ValueRange& domain) noexcept {
    return std::max({std::abs(intercept), std::abs(texel), std::abs(domain.lo), std::abs(domain.hi)});
}

/// Ranges of scalars of a transfer function's table with an opacity of at least a threshold, conservatively:
/// mayBeOpaque() is false only if no sampler, whatever the precision of its weights, returns an opaque sample for any
/// scalar of the range. Prefix counts over the table's entries: a query takes two lookups.
class OpaqueRanges {
  public:
    /// `table` as sampleTable() returns it. A threshold that is not positive makes every scalar opaque. `largest` is
    /// largestTerm(): with a domain that is narrow compared with it, the scalar is off by more than an entry.
    OpaqueRanges(std::span<const float> table, const ValueRange& domain, double threshold, double largest = 0);

    /// Returns true if a scalar of the closed range (in the image's own units) may be opaque.
    [[nodiscard]] bool mayBeOpaque(const ValueRange& range) const noexcept;
    /// Returns true if no scalar is opaque: nothing is visible.
    [[nodiscard]] bool nothingOpaque() const noexcept { return opaqueBefore_.back() == 0; }

  private:
    /// The entries that the scalars of a range can look up.
    struct Entries {
        std::size_t first = 0;
        std::size_t last = 0;
    };
    [[nodiscard]] double entry(double value) const noexcept;
    [[nodiscard]] Entries entries(const ValueRange& range) const noexcept;

    ValueRange domain_;
    double entryMargin_;                      ///< entries to each side that a scalar may look up by rounding
    std::vector<std::uint32_t> opaqueBefore_; ///< [i]: opaque entries below i; one more element than entries
};

} // namespace voxtact
