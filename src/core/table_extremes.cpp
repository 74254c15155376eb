// SPDX-License-Identifier: MIT
#include "core/table_extremes.h"

#include <algorithm>
#include <bit>

namespace voxtact {

std::size_t tableLevels(std::size_t entries) noexcept {
    return static_cast<std::size_t>(std::bit_width(entries));
}

std::vector<float> tableExtremes(std::span<const float> table) {
    const std::size_t entries = table.size();
    const std::size_t levels = tableLevels(entries);
    std::vector<float> out(2 * levels * entries);
    std::copy(table.begin(), table.end(), out.begin());
    std::copy(table.begin(), table.end(), out.begin() + static_cast<std::ptrdiff_t>(levels * entries));
    for (std::size_t level = 1; level < levels; ++level) {
        const std::size_t halfSpan = std::size_t{1} << (level - 1);
        float* maxima = out.data() + level * entries;
        float* minima = out.data() + (levels + level) * entries;
        for (std::size_t i = 0; i < entries; ++i) {
            const std::size_t other = std::min(i + halfSpan, entries - 1);
            maxima[i] = std::max((maxima - entries)[i], (maxima - entries)[other]);
            minima[i] = std::min((minima - entries)[i], (minima - entries)[other]);
        }
    }
    return out;
}

} // namespace voxtact
