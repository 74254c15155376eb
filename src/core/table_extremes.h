// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace voxtact {

/// Levels of a sparse table over `entries`: the spans of 1, 2, 4, ... entries that fit.
[[nodiscard]] std::size_t tableLevels(std::size_t entries) noexcept;

/// The extremes of every span of 2^k entries of a transfer function's table, so that the extremes of any range are two
/// look-ups (a sparse table: Bender and Farach-Colton, "The LCA problem revisited", 2000, section 3). With N entries
/// and K = tableLevels(N): the maximum of the span that begins at entry i is at [k * N + i], its minimum at
/// [(K + k) * N + i]. Where a span would leave the table, so does not end, stands the extreme of what there is.
[[nodiscard]] std::vector<float> tableExtremes(std::span<const float> table);

} // namespace voxtact
