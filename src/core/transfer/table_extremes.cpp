// SPDX-License-Identifier: MIT
#include "core/transfer/table_extremes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace voxtact {

namespace {

/// Level k for a run of 2^k entries, the longest that is not longer than `entries`.
std::uint32_t levelOf(std::uint32_t entries) {
    return static_cast<std::uint32_t>(std::bit_width(entries)) - 1;
}

} // namespace

TableExtremes::TableExtremes(std::span<const float> table) : entries_(static_cast<std::uint32_t>(table.size())) {
    const std::size_t n = table.size();
    const std::size_t half = levels() * n;
    values_.resize(2 * half);
    for (std::size_t i = 0; i < n; ++i) {
        values_[i] = std::isnan(table[i]) ? -std::numeric_limits<float>::infinity() : table[i];
        values_[half + i] = values_[i];
    }
    for (std::uint32_t level = 1; level < levels(); ++level) {
        const float* below = values_.data() + (level - 1) * n;
        float* here = values_.data() + level * n;
        const std::size_t run = std::size_t{1} << (level - 1);
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t second = i + run < n ? i + run : i;
            here[i] = std::max(below[i], below[second]);
            here[half + i] = std::min(below[half + i], below[half + second]);
        }
    }
}

std::uint32_t TableExtremes::levelsOf(std::size_t entries) noexcept {
    return static_cast<std::uint32_t>(std::bit_width(entries));
}

float TableExtremes::greatest(std::uint32_t first, std::uint32_t last) const noexcept {
    const std::uint32_t level = levelOf(last - first + 1);
    const float* row = values_.data() + std::size_t{level} * entries_;
    return std::max(row[first], row[last + 1 - (1U << level)]);
}

float TableExtremes::least(std::uint32_t first, std::uint32_t last) const noexcept {
    const std::uint32_t level = levelOf(last - first + 1);
    const float* row = values_.data() + std::size_t{levels() + level} * entries_;
    return std::min(row[first], row[last + 1 - (1U << level)]);
}

} // namespace voxtact
