// SPDX-License-Identifier: MIT
#include "cpu/certified/certified_bricks.h"
#include "cpu/scene/stored_voxels.h"

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

/// Those that are corners of a brick's cells, or of those one farther out.
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

constexpr std::int32_t kCorners = kBrickSide + 1;

/// The least and the greatest entry coordinate at the corners of cells, found along one axis after the other.
struct CornerRanges {
    float lo[kCorners][kCorners][kCorners]; ///< [z][y][x]
    float hi[kCorners][kCorners][kCorners];
};

template <class Kept>
void loadCorners(const StoredImage& image, const Kept* voxels, const shader::CertifiedItem& item,
                 const std::array<std::int32_t, 3>& place, CornerRanges& out) {
    std::array<std::int64_t, 3> first{};
    std::array<std::int64_t, 3> last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = std::int64_t{place[axis]} << kBrickShift;
        // Cells beyond the last are no cells: whatever stands there is not looked at.
        last[axis] = std::int64_t{image.size[axis]} + 1;
    }
    for (std::int64_t z = 0; z < kCorners; ++z) {
        for (std::int64_t y = 0; y < kCorners; ++y) {
            const Kept* row = voxels + std::min(first[1] + y, last[1]) * image.stride[1] +
                              std::min(first[2] + z, last[2]) * image.stride[2];
            for (std::int64_t x = 0; x < kCorners; ++x) {
                out.lo[z][y][x] = shader::certifiedEntry(item, storedValue(row[std::min(first[0] + x, last[0])]));
                out.hi[z][y][x] = out.lo[z][y][x];
            }
        }
    }
}

void reduce(CornerRanges& ranges) {
    const auto merge = [&](int z, int y, int x, int otherZ, int otherY, int otherX) {
        ranges.lo[z][y][x] = shader::certifiedMin(ranges.lo[z][y][x], ranges.lo[otherZ][otherY][otherX]);
        ranges.hi[z][y][x] = shader::certifiedMax(ranges.hi[z][y][x], ranges.hi[otherZ][otherY][otherX]);
    };
    for (int z = 0; z < kCorners; ++z) {
        for (int y = 0; y < kCorners; ++y) {
            for (int x = 0; x < kBrickSide; ++x) {
                merge(z, y, x, z, y, x + 1);
            }
        }
    }
    for (int z = 0; z < kCorners; ++z) {
        for (int y = 0; y < kBrickSide; ++y) {
            for (int x = 0; x < kBrickSide; ++x) {
                merge(z, y, x, z, y + 1, x);
            }
        }
    }
    for (int z = 0; z < kBrickSide; ++z) {
        for (int y = 0; y < kBrickSide; ++y) {
            for (int x = 0; x < kBrickSide; ++x) {
                merge(z, y, x, z + 1, y, x);
            }
        }
    }
}

void grow(CellBox& box, const std::array<std::int32_t, 3>& cell) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::min(box.lo[axis], cell[axis]);
        box.hi[axis] = std::max(box.hi[axis], cell[axis]);
    }
}

} // namespace

bool BrickCells::any(const CellBox& box) const noexcept {
    const unsigned columns = (2U << static_cast<unsigned>(box.hi[0])) - (1U << static_cast<unsigned>(box.lo[0]));
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

CertifiedBricks::CertifiedBricks(std::span<const std::uint8_t> mixed) : slots_(mixed.size()), mutex_(new std::mutex) {
    std::uint32_t count = 0;
    for (std::size_t brick = 0; brick < mixed.size(); ++brick) {
        slots_[brick] = count;
        count += mixed[brick] != 0 ? 1 : 0;
    }
    made_ = std::make_unique<std::atomic<bool>[]>(count);
    cells_ = std::make_unique<BrickCells[]>(count);
}

void CertifiedBricks::make(const VolumeImpl& volume, const shader::CertifiedItem& item,
                           const shader::OpacityTable& table, std::uint32_t slot,
                           const std::array<std::int32_t, 3>& place) const {
    BrickCells made;
    CornerRanges ranges;
    volume.image.visit([&](const auto* voxels) {
        findRange(volume.image, voxels, place, made);
        loadCorners(volume.image, voxels, item, place, ranges);
    });
    reduce(ranges);
    const float error = shader::certifiedPointError(item, made.wideLo, made.wideHi);
    for (int z = 0; z < kBrickSide; ++z) {
        for (int y = 0; y < kBrickSide; ++y) {
            unsigned row = 0;
            for (int x = 0; x < kBrickSide; ++x) {
                const bool may = shader::certifiedMayBeOpaque(table, ranges.lo[z][y][x], ranges.hi[z][y][x], error);
                row |= (may ? 1U : 0U) << static_cast<unsigned>(x);
            }
            if (row != 0) {
                grow(made.around, {std::countr_zero(row), y, z});
                grow(made.around, {static_cast<std::int32_t>(std::bit_width(row)) - 1, y, z});
            }
            made.mayBeOpaque[static_cast<std::size_t>(y + kBrickSide * z)] = static_cast<std::uint8_t>(row);
        }
    }
    const std::lock_guard lock(*mutex_);
    if (!made_[slot].load(std::memory_order_relaxed)) {
        cells_[slot] = made;
        made_[slot].store(true, std::memory_order_release);
    }
}

} // namespace voxtact::cpu
