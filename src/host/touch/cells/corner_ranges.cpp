// SPDX-License-Identifier: MIT
#include "host/touch/cells/corner_ranges.h"
#include "host/scene/stored_voxels.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/touch/cells/corner_ranges.cpp"
#include <hwy/foreach_target.h>

#include "host/touch/cells/simd_rows.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace {

using Floats = RowFloats;
using FloatV = RowV;
constexpr std::size_t kCells = kBrickSide;
constexpr std::size_t kCorners = CornerRanges::kCorners;
/// Steps from a corner to the next one along y and z.
constexpr std::size_t kRow = kCorners;
constexpr std::size_t kSlice = kCorners * kCorners;

/// Same as certifiedMin() and certifiedMax(): NaN stays if it is first.
HWY_INLINE FloatV lesser(FloatV a, FloatV b) {
    return hn::IfThenElse(hn::Lt(b, a), b, a);
}
HWY_INLINE FloatV greater(FloatV a, FloatV b) {
    return hn::IfThenElse(hn::Gt(b, a), b, a);
}

/// Converts stored values to entries, like certifiedEntry(). False if one is not finite.
bool toEntries(const shader::CertifiedItem& item, float* values, std::size_t count) {
    const Floats d;
    const FloatV reference = hn::Set(d, item.storedReference);
    const FloatV scale = hn::Set(d, item.entryScale);
    const FloatV infinity = hn::Set(d, std::numeric_limits<float>::infinity());
    auto finite = hn::Eq(infinity, infinity);
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
        const FloatV entry = hn::Mul(hn::Sub(hn::LoadU(d, values + i), reference), scale);
        finite = hn::And(finite, hn::Lt(hn::Abs(entry), infinity));
        hn::StoreU(entry, d, values + i);
    }
    bool all = hn::AllTrue(d, finite);
    for (; i < count; ++i) {
        values[i] = shader::certifiedEntry(item, values[i]);
        all = all && shader::certifiedAbs(values[i]) < std::numeric_limits<float>::infinity();
    }
    return all;
}

/// Merges each of `rows` rows of cells with the row `step` further on.
HWY_INLINE void merge(float* lo, float* hi, std::size_t slices, std::size_t rows, std::size_t step) {
    const Floats d;
    for (std::size_t z = 0; z < slices; ++z) {
        for (std::size_t y = 0; y < rows; ++y) {
            const std::size_t row = z * kSlice + y * kRow;
            for (std::size_t x = 0; x < kCells; x += hn::Lanes(d)) {
                float* const least = lo + row + x;
                float* const most = hi + row + x;
                hn::StoreU(lesser(hn::LoadU(d, least), hn::LoadU(d, least + step)), d, least);
                hn::StoreU(greater(hn::LoadU(d, most), hn::LoadU(d, most + step)), d, most);
            }
        }
    }
}

/// Converts corner values to cell ranges.
void reduce(CornerRanges& ranges) {
    float* const lo = &ranges.lo[0][0][0];
    float* const hi = &ranges.hi[0][0][0];
    std::copy_n(lo, kSlice * kCorners, hi);
    merge(lo, hi, kCorners, kCorners, 1);
    merge(lo, hi, kCorners, kCells, kRow);
    merge(lo, hi, kCells, kCells, kSlice);
}

/// The cells for which `ask(lo, hi)` is true.
template <class Ask> HWY_INLINE CellBits cellsFor(const CornerRanges& ranges, const Ask& ask) {
    const Floats d;
    CellBits cells{};
    for (std::size_t z = 0; z < kCells; ++z) {
        for (std::size_t y = 0; y < kCells; ++y) {
            unsigned row = 0;
            for (std::size_t x = 0; x < kCells; x += hn::Lanes(d)) {
                const FloatV lo = hn::LoadU(d, &ranges.lo[z][y][x]);
                const FloatV hi = hn::LoadU(d, &ranges.hi[z][y][x]);
                row |= bitsOf(ask(lo, hi)) << x;
            }
            cells[y + kCells * z] = static_cast<std::uint8_t>(row);
        }
    }
    return cells;
}

/// NaN meets every range.
CellBits meeting(const CornerRanges& ranges, float error, float first, float last) {
    const Floats d;
    const FloatV wide = hn::Set(d, error);
    return cellsFor(ranges, [&](FloatV lo, FloatV hi) {
        return hn::Not(
            hn::Or(hn::Lt(hn::Add(hi, wide), hn::Set(d, first)), hn::Gt(hn::Sub(lo, wide), hn::Set(d, last))));
    });
}

/// NaN is inside no range.
CellBits inside(const CornerRanges& ranges, float error, float first, float last) {
    const Floats d;
    const FloatV wide = hn::Set(d, error);
    return cellsFor(ranges, [&](FloatV lo, FloatV hi) {
        return hn::And(hn::Ge(hn::Sub(lo, wide), hn::Set(d, first)), hn::Le(hn::Add(hi, wide), hn::Set(d, last)));
    });
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxtact::cpu {

HWY_EXPORT(toEntries);
HWY_EXPORT(reduce);
HWY_EXPORT(meeting);
HWY_EXPORT(inside);

namespace {

/// The stored values at the corners, to `lo`.
template <class Kept>
void loadCorners(const StoredImage& image, const Kept* voxels, const std::array<std::int32_t, 3>& place,
                 CornerRanges& out) {
    constexpr auto kCorners = static_cast<std::int64_t>(CornerRanges::kCorners);
    std::array<std::int64_t, 3> first{};
    std::array<std::int64_t, 3> last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = std::int64_t{place[axis]} << kBrickShift;
        // Entries beyond the last cell are not used.
        last[axis] = std::int64_t{image.size[axis]} + 1;
    }
    const std::int64_t inside = std::min(kCorners, last[0] + 1 - first[0]);
    for (std::int64_t z = 0; z < kCorners; ++z) {
        for (std::int64_t y = 0; y < kCorners; ++y) {
            const Kept* row = voxels + std::min(first[1] + y, last[1]) * image.stride[1] +
                              std::min(first[2] + z, last[2]) * image.stride[2] + first[0];
            float* const to = out.lo[z][y];
            for (std::int64_t x = 0; x < inside; ++x) {
                to[x] = storedValue(row[x]);
            }
            std::fill(to + inside, to + kCorners, to[inside - 1]);
        }
    }
}

} // namespace

CornerRanges cornerRangesOf(const StoredImage& image, const shader::CertifiedItem& item,
                            const std::array<std::int32_t, 3>& place) {
    CornerRanges ranges;
    image.visit([&](const auto* voxels) { loadCorners(image, voxels, place, ranges); });
    constexpr std::size_t kCount = CornerRanges::kCorners * CornerRanges::kCorners * CornerRanges::kCorners;
    ranges.finite = HWY_DYNAMIC_DISPATCH(toEntries)(item, &ranges.lo[0][0][0], kCount);
    HWY_DYNAMIC_DISPATCH(reduce)(ranges);
    return ranges;
}

CellBits cellsThatMeet(const CornerRanges& ranges, float error, float first, float last) {
    return HWY_DYNAMIC_DISPATCH(meeting)(ranges, error, first, last);
}

CellBits cellsWithin(const CornerRanges& ranges, float error, float first, float last) {
    return HWY_DYNAMIC_DISPATCH(inside)(ranges, error, first, last);
}

} // namespace voxtact::cpu
#endif
