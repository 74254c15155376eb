// SPDX-License-Identifier: MIT
#pragma once

#include "certified.h"
#include "cpu/certified/cell_box.h"
#include "cpu/scene/stored_image.h"

#include <array>
#include <cstdint>

namespace voxtact::cpu {

/// Of a brick's cells: the least and the greatest entry coordinate at the corners, NaN passed over.
struct CornerRanges {
    static constexpr std::int32_t kCorners = kBrickSide + 1;

    bool finite = true;                     ///< all of them
    float lo[kCorners][kCorners][kCorners]; ///< [z][y][x]; only those of kBrickSide cells a side are set in the end
    float hi[kCorners][kCorners][kCorners];
};

/// `place`: the brick's number along each axis.
[[nodiscard]] CornerRanges cornerRangesOf(const StoredImage& image, const shader::CertifiedItem& item,
                                          const std::array<std::int32_t, 3>& place);

} // namespace voxtact::cpu
