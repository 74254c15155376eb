// SPDX-License-Identifier: MIT
#pragma once

#include "core/volume/bricks.h"
#include "host/count/brick_sums.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// Cells of a brick's side.
inline constexpr std::int32_t kBrickSide = 1 << kBrickShift;

/// A box of cells, both ends inclusive, numbered from -1.
struct CellBox {
    std::array<std::int32_t, 3> lo{};
    std::array<std::int32_t, 3> hi{};

    [[nodiscard]] bool empty() const noexcept { return hi[0] < lo[0] || hi[1] < lo[1] || hi[2] < lo[2]; }
    [[nodiscard]] bool single() const noexcept { return hi == lo; }
    /// A bit for each of its places along x. Expects some cells of a brick, numbered within it.
    [[nodiscard]] unsigned columns() const noexcept {
        return (2U << static_cast<unsigned>(hi[0])) - (1U << static_cast<unsigned>(lo[0]));
    }
    [[nodiscard]] BrickBox bricks() const noexcept {
        BrickBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = (lo[axis] + 1) >> kBrickShift;
            box.hi[axis] = (hi[axis] + 1) >> kBrickShift;
        }
        return box;
    }
    /// Returns the cells in a brick, numbered in it from 0. Expects one of bricks().
    [[nodiscard]] CellBox within(const std::array<std::int32_t, 3>& brick) const noexcept {
        CellBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int32_t first = (brick[axis] << kBrickShift) - 1;
            box.lo[axis] = std::max(lo[axis] - first, 0);
            box.hi[axis] = std::min(hi[axis] - first, kBrickSide - 1);
        }
        return box;
    }
};

} // namespace voxtact::cpu
