// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <vector>

/// Zoomable axis of values below the transfer function's curve. Pure functions; `whole` is a domain with finite,
/// ascending ends, `shown` a part of it.
namespace voxtact::view {

/// Values to the right.
struct ChartAxis {
    double left = 0;  ///< points of the window
    double width = 1; ///< the same, above 0
    ValueRange shown; ///< from the left side to the right one

    /// Position of a value; beyond the sides if it is not visible.
    [[nodiscard]] double at(double value) const noexcept {
        return left + (value - shown.lo) / (shown.hi - shown.lo) * width;
    }
    [[nodiscard]] double valueAt(double x) const noexcept {
        return shown.lo + (x - left) / width * (shown.hi - shown.lo);
    }
};

/// Scales the visible range by a factor (below 1: nearer), keeping `about` in place as far as the domain allows.
/// Minimum: a hundred thousandth of the domain.
[[nodiscard]] ValueRange zoomed(const ValueRange& shown, const ValueRange& whole, double factor, double about) noexcept;

/// Moved by a difference of values, within the whole.
[[nodiscard]] ValueRange panned(const ValueRange& shown, const ValueRange& whole, double by) noexcept;

[[nodiscard]] constexpr bool isWhole(const ValueRange& shown, const ValueRange& whole) noexcept {
    return shown.lo <= whole.lo && shown.hi >= whole.hi;
}

/// Round values within a range, ascending, `most` at most (at least 1): multiples of 1, 2 or 5 times a power of ten.
[[nodiscard]] std::vector<double> axisTicks(const ValueRange& shown, std::size_t most);

} // namespace voxtact::view
