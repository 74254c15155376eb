// SPDX-License-Identifier: MIT
#include "host/touch/cells/certified_bricks.h"
#include "host/scene/stored_voxels.h"
#include "host/touch/cells/corner_ranges.h"
#include "host/touch/cells/triangle_cells.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace voxtact::cpu {

namespace {

/// Padded voxels along an axis.
struct Extent {
    std::int64_t first;
    std::int64_t end;
};

/// Corners of a brick's cells and their neighbours.
Extent wideExtent(std::int32_t brick, std::int32_t size) {
    const std::int64_t first = std::int64_t{brick} << kBrickShift;
    return {std::max<std::int64_t>(first - 1, 0),
            std::min<std::int64_t>(first + kBrickSide + 2, std::int64_t{size} + 2)};
}

template <class Kept>
void findRange(const StoredImage& image, const Kept* voxels, const std::array<std::int32_t, 3>& place,
               BrickCells& out) {
    const Extent x = wideExtent(place[0], image.size[0]);
    const Extent y = wideExtent(place[1], image.size[1]);
    const Extent z = wideExtent(place[2], image.size[2]);
    Kept lo = voxels[x.first + y.first * image.stride[1] + z.first * image.stride[2]];
    Kept hi = lo;
    for (std::int64_t slice = z.first; slice < z.end; ++slice) {
        for (std::int64_t row = y.first; row < y.end; ++row) {
            const Kept* at = voxels + row * image.stride[1] + slice * image.stride[2];
            for (std::int64_t column = x.first; column < x.end; ++column) {
                lo = std::min(lo, at[column]);
                hi = std::max(hi, at[column]);
            }
        }
    }
    out.wideLo = storedValue(lo);
    out.wideHi = storedValue(hi);
}

void grow(CellBox& box, const std::array<std::int32_t, 3>& cell) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::min(box.lo[axis], cell[axis]);
        box.hi[axis] = std::max(box.hi[axis], cell[axis]);
    }
}

/// Returns the cells of a row, given by their ranges, that may be opaque under several intervals.
std::uint8_t withoutHoles(const shader::OpaqueValues& opaque, std::uint8_t row, const float* lo, const float* hi,
                          float error) {
    unsigned kept = 0;
    for (unsigned left = row; left != 0; left &= left - 1) {
        const auto x = static_cast<unsigned>(std::countr_zero(left));
        kept |= shader::certifiedMayBeOpaque(opaque, lo[x], hi[x], error) ? 1U << x : 0U;
    }
    return static_cast<std::uint8_t>(kept);
}

/// Returns the cells of a brick inside the domain.
CellBox wholeCells(const StoredImage& image, const std::array<std::int32_t, 3>& place) {
    CellBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int32_t first = place[axis] << kBrickShift; // of padded voxels: cell -1
        box.lo[axis] = first == 0 ? 1 : 0;
        box.hi[axis] = std::min(kBrickSide, image.size[axis] - first) - 1;
    }
    return box;
}

} // namespace

bool BrickCells::any(const CellBox& box) const noexcept {
    const unsigned columns = box.columns();
    // Eight rows, a slice, in a word.
    const auto firstRow = static_cast<unsigned>(8 * box.lo[1]);
    const auto afterRow = static_cast<unsigned>(8 * (kBrickSide - 1 - box.hi[1]));
    const std::uint64_t mask =
        (columns * 0x0101010101010101ULL) & ((~std::uint64_t{0} << firstRow) & (~std::uint64_t{0} >> afterRow));
    std::uint64_t found = 0;
    for (std::int32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
        found |= slice(z);
    }
    return (found & mask) != 0;
}

std::uint64_t BrickCells::slice(std::int32_t z) const noexcept {
    const std::uint8_t* rows = mayBeOpaque.data() + kBrickSide * z;
    std::uint64_t slice = 0;
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(&slice, rows, sizeof slice);
    } else {
        for (std::int32_t y = 0; y < kBrickSide; ++y) {
            slice |= std::uint64_t{rows[y]} << static_cast<unsigned>(8 * y);
        }
    }
    return slice;
}

CertifiedBricks::CertifiedBricks(std::span<const std::uint8_t> mixed) : slots_(mixed.size()) {
    std::uint32_t count = 0;
    for (std::size_t brick = 0; brick < mixed.size(); ++brick) {
        slots_[brick] = count;
        count += mixed[brick] != 0 ? 1 : 0;
    }
    cells_ = MadeOnce<BrickCells>(count);
    allOpaque_ = MadeOnce<CellBits>(count);
}

const BrickCells& CertifiedBricks::makeCells(const VolumeImpl& volume, const shader::CertifiedItem& item,
                                             const shader::OpaqueValues& opaque, std::size_t number,
                                             const std::array<std::int32_t, 3>& place) const {
    BrickCells made;
    volume.image.visit([&](const auto* voxels) { findRange(volume.image, voxels, place, made); });
    const CornerRanges ranges = cornerRangesOf(volume.image, item, place);
    const float error = shader::certifiedPointError(item, made.wideLo, made.wideHi);
    made.mayBeOpaque = cellsThatMeet(ranges, error, opaque.bounds.first, opaque.bounds.last);
    for (int z = 0; z < kBrickSide; ++z) {
        for (int y = 0; y < kBrickSide; ++y) {
            std::uint8_t& row = made.mayBeOpaque[static_cast<std::size_t>(y + kBrickSide * z)];
            if (opaque.outer > 1) {
                row = withoutHoles(opaque, row, ranges.lo[z][y], ranges.hi[z][y], error);
            }
            if (row != 0) {
                grow(made.around, {std::countr_zero(row), y, z});
                grow(made.around, {static_cast<std::int32_t>(std::bit_width(row)) - 1, y, z});
            }
        }
    }
    return cells_.keep(slots_[number], made);
}

const CellBits& CertifiedBricks::makeAllOpaque(const VolumeImpl& volume, const shader::CertifiedItem& item,
                                               const shader::OpaqueValues& opaque, std::size_t number,
                                               const std::array<std::int32_t, 3>& place) const {
    const BrickCells& known = at(volume, item, opaque, number, place);
    // Displacement of tested points, in margins of the cell.
    constexpr float kMargins = 2;
    const float error = shader::certifiedPointError(item, known.wideLo, known.wideHi);
    const float margin =
        kMargins * shader::certifiedMargin(item, error, known.wideLo, known.wideHi, TriangleCells::kMostDelta);
    const CornerRanges ranges = cornerRangesOf(volume.image, item, place);
    const CellBox whole = wholeCells(volume.image, place);
    if (!ranges.finite || whole.empty()) {
        return allOpaque_.keep(slots_[number], {});
    }
    CellBits made = cellsWithin(ranges, margin, opaque.bounds.allFirst, opaque.bounds.allLast);
    for (int z = 0; z < kBrickSide; ++z) {
        for (int y = 0; y < kBrickSide; ++y) {
            const bool inside = z >= whole.lo[2] && z <= whole.hi[2] && y >= whole.lo[1] && y <= whole.hi[1];
            std::uint8_t& row = made[static_cast<std::size_t>(y + kBrickSide * z)];
            row = inside ? static_cast<std::uint8_t>(row & whole.columns()) : 0;
        }
    }
    return allOpaque_.keep(slots_[number], made);
}

} // namespace voxtact::cpu
