// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace voxtact::app {

/// Red, green and blue.
using Rgb = std::array<std::uint8_t, 3>;

/// viridis (van der Walt, Smith, Firing, matplotlib 1.5, CC0): lightness rises evenly from dark violet to yellow.
/// `share`: 0 to 1 along the map.
[[nodiscard]] inline Rgb viridis(double share) {
    // At every eighth.
    constexpr std::array<Rgb, 9> kMap{{{68, 1, 84},
                                       {71, 44, 122},
                                       {59, 81, 139},
                                       {44, 113, 142},
                                       {33, 144, 141},
                                       {39, 173, 129},
                                       {92, 200, 99},
                                       {170, 220, 50},
                                       {253, 231, 37}}};
    const double place = std::clamp(share, 0.0, 1.0) * (kMap.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), kMap.size() - 2);
    const double part = place - static_cast<double>(below);
    Rgb colour{};
    for (std::size_t i = 0; i < colour.size(); ++i) {
        colour[i] = static_cast<std::uint8_t>(std::lround(kMap[below][i] * (1 - part) + kMap[below + 1][i] * part));
    }
    return colour;
}

} // namespace voxtact::app
