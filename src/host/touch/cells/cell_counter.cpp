// SPDX-License-Identifier: MIT
#include "host/touch/cells/cell_counter.h"
#include "host/touch/cells/cell_block.h"

#include <cmath>
#include <limits>

namespace voxtact::cpu {

namespace {

using Bits = TriangleCells::Bits;

/// Returns the bit of a cell in the cube that begins at `first`; 0 for cells outside it.
Bits bitIn(const std::array<std::int32_t, 3>& cell, const std::array<std::int32_t, 3>& first) {
    unsigned number = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
        const auto place = static_cast<unsigned>(cell[axis]) - static_cast<unsigned>(first[axis]);
        if (place >= TriangleCells::kSide) {
            return 0;
        }
        number = number * TriangleCells::kSide + place;
    }
    return Bits{1} << number;
}

/// The cell that a point is in.
std::array<std::int32_t, 3> cellOf(const shader::VoxelPoint& point) {
    const auto along = [](float at) {
        // A coordinate beyond all cells, in no triangle.
        constexpr float kBeyond = 1e9F;
        if (!(std::abs(at) < kBeyond)) {
            return std::numeric_limits<std::int32_t>::min();
        }
        const auto cut = static_cast<std::int32_t>(at);
        return static_cast<float>(cut) > at ? cut - 1 : cut;
    };
    return {along(point.x), along(point.y), along(point.z)};
}

} // namespace

void CellCounter::begin(const shader::CertifiedTriangle& triangle) noexcept {
    triangle_ = &triangle;
    overlap_.reset();
    corners_ = {cellOf(triangle.corner0), cellOf(triangle.corner1), cellOf(triangle.corner2)};
}

CellCounter::Cube CellCounter::cubeOf(const Part& part, const Place& from) noexcept {
    constexpr auto kSide = static_cast<std::int32_t>(TriangleCells::kSide);
    const unsigned columns = part.within.columns();
    Cube cube;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        cube.first[axis] = (part.brick[axis] << kBrickShift) - 1 + from[axis];
    }
    for (std::int32_t z = from[2]; z < from[2] + kSide && z <= part.within.hi[2]; ++z) {
        for (std::int32_t y = from[1]; y < from[1] + kSide && y <= part.within.hi[1]; ++y) {
            const auto row = static_cast<std::size_t>(y + kBrickSide * z);
            const auto shift = static_cast<unsigned>(kSide * (y - from[1] + kSide * (z - from[2])));
            const auto bits = [&](unsigned of) {
                const unsigned here = (of & columns) >> static_cast<unsigned>(from[0]);
                return Bits{here & ((1U << TriangleCells::kSide) - 1)} << shift;
            };
            cube.mayBeOpaque |= bits(part.mayBeOpaque[row]);
            cube.allOpaque |= bits(part.allOpaque[row]);
        }
    }
    return cube;
}

CellCounter::Left CellCounter::countCube(const Cube& cube, unsigned& certain) noexcept {
    Bits counted = 0;
    for (const Place& corner : corners_) {
        counted |= bitIn(corner, cube.first); // it is not cut off there
    }
    counted &= cube.mayBeOpaque & cube.allOpaque;
    Left left{cube.mayBeOpaque & ~counted, 0};
    if (left.cells != 0) {
        if (!overlap_) {
            overlap_.emplace(*triangle_);
        }
        const TriangleCells::Overlap overlap = overlap_->of(left.cells, cube.first);
        counted |= overlap.some & cube.allOpaque;
        left.cells &= ~(counted | overlap.none);
        left.passed = left.cells & overlap.some;
    }
    certain += bitsIn(counted);
    return left;
}

} // namespace voxtact::cpu
