// SPDX-License-Identifier: MIT
#pragma once

#include "exact/certified.h"
#include "host/scene/stored_image.h"
#include "host/touch/cells/cell_box.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// A bit for each cell of a brick: bit x of [y + 8 * z].
using CellBits = std::array<std::uint8_t, std::size_t{kBrickSide} * kBrickSide>;
static_assert(kBrickSide == 8, "a row of cells is a byte");

/// Minimum and maximum entry at the corners of a brick's cells. NaN replaces both if it is at the corner with the
/// lowest coordinates; otherwise it is skipped.
struct CornerRanges {
    static constexpr std::size_t kCorners = kBrickSide + 1;

    bool finite = true; ///< all corners of all cells
    /// [z][y][x]; those beyond the cells are of no meaning.
    float lo[kCorners][kCorners][kCorners];
    float hi[kCorners][kCorners][kCorners];
};

/// `place`: the brick's number along each axis.
[[nodiscard]] CornerRanges cornerRangesOf(const StoredImage& image, const shader::CertifiedItem& item,
                                          const std::array<std::int32_t, 3>& place);
/// The cells whose range, wider by `error` on both sides, neither ends before `first` nor begins after `last`.
[[nodiscard]] CellBits cellsThatMeet(const CornerRanges& ranges, float error, float first, float last);
/// Returns the cells whose range is within `first` and `last`.
[[nodiscard]] CellBits cellsWithin(const CornerRanges& ranges, float error, float first, float last);

} // namespace voxtact::cpu
