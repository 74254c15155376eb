// SPDX-License-Identifier: MIT
#include "cpu/certified/row_counter.h"

#include <bit>

namespace voxtact::cpu {

namespace {

/// The cells of a row that a corner of the triangle is in: it is not cut off there.
unsigned cornersIn(const shader::CertifiedTriangle& triangle, const std::array<std::int32_t, 3>& first) {
    constexpr auto kEnd = static_cast<float>(TriangleCells::kRow);
    const shader::VoxelPoint from{static_cast<float>(first[0]), static_cast<float>(first[1]),
                                  static_cast<float>(first[2])};
    unsigned found = 0;
    for (const shader::VoxelPoint& corner : {triangle.corner0, triangle.corner1, triangle.corner2}) {
        const shader::VoxelPoint at = shader::voxelDifference(corner, from);
        const bool inRow = at.y >= 0 && at.y <= 1 && at.z >= 0 && at.z <= 1 && at.x >= 0 && at.x < kEnd;
        found |= inRow ? 1U << static_cast<unsigned>(at.x) : 0U;
    }
    return found;
}

} // namespace

RowCounter::Row RowCounter::count(const shader::CertifiedTriangle& triangle, unsigned row, unsigned allOpaque,
                                  const std::array<std::int32_t, 3>& first) noexcept {
    unsigned counted = row & allOpaque;
    if (counted == 0) {
        return {0, row};
    }
    counted &= cornersIn(triangle, first);
    row &= ~counted;
    if ((row & allOpaque) != 0) {
        if (!cells_) {
            cells_.emplace(triangle);
        }
        const TriangleCells::Row passed = cells_->row(first[0], first[1], first[2]);
        counted |= row & allOpaque & passed.some;
        row &= ~(counted | passed.none);
    }
    return {static_cast<unsigned>(std::popcount(counted)), row};
}

} // namespace voxtact::cpu
