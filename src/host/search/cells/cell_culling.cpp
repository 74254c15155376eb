// SPDX-License-Identifier: MIT
#include "host/search/cells/cell_culling.h"
#include "core/base/infinity.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/search/cells/cell_culling.cpp"
#include <hwy/foreach_target.h>

#include "host/search/cells/simd_space.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace {

constexpr auto kSide = static_cast<std::size_t>(kBrickSide);

HWY_INLINE double leastOf(DoubleV v) {
    const Doubles d;
    alignas(kRowAlignment) std::array<double, kMostDoubles> lanes;
    hn::Store(v, d, lanes.data());
    double least = lanes[0];
    for (std::size_t i = 1; i < hn::Lanes(d); ++i) {
        least = lanes[i] < least ? lanes[i] : least;
    }
    return least;
}

/// Some columns of a row.
struct RowPart {
    unsigned bits = 0;
    double base = 0; ///< of the row, along the normal
    double* lo = nullptr;
};

HWY_INLINE unsigned cullRow(const CellCullingJob& job, const RowPart& row, DoubleV& gone) {
    const Doubles d;
    const std::size_t lanes = hn::Lanes(d);
    unsigned kept = 0;
    for (std::size_t x = 0; x < kSide; x += lanes) {
        const unsigned bits = row.bits >> x & ((1U << lanes) - 1);
        if (bits == 0) {
            continue;
        }
        const DoubleV way = hn::Mul(all(job.along.x), hn::Iota(d, static_cast<double>(x)));
        const DoubleV apart = hn::Mul(hn::Add(all(row.base), way), all(job.inverse));
        const DoubleV lo = greater(below(apart, job.error), all(job.least));
        const DoubleM near = hn::And(maskOf(bits), hn::Lt(lo, all(job.cut)));
        gone = lesser(hn::IfThenElse(hn::AndNot(near, maskOf(bits)), lo, gone), gone);
        hn::Store(lo, d, row.lo + x);
        kept |= bitsOf(near) << x;
    }
    return kept;
}

void cullCells(const CellCullingJob& job, RemainingCells& out) {
    DoubleV gone = all(kInfinity);
    for (std::int32_t z = job.cells.lo[2]; z <= job.cells.hi[2]; ++z) {
        for (std::int32_t y = job.cells.lo[1]; y <= job.cells.hi[1]; ++y) {
            const auto number = static_cast<std::size_t>(y + kBrickSide * z);
            const RowPart row{job.known.row(job.cells, y, z), job.base + job.along.y * y + job.along.z * z,
                              out.lo.data() + number * kSide};
            out.kept[number] = static_cast<std::uint8_t>(row.bits != 0 ? cullRow(job, row, gone) : 0);
        }
    }
    out.leastGone = leastOf(gone);
}

void cullNear(const NearCellsJob& job, RemainingCells& out) {
    const Doubles d;
    const std::size_t lanes = hn::Lanes(d);
    for (std::int32_t z = job.cells.lo[2]; z <= job.cells.hi[2]; ++z) {
        for (std::int32_t y = job.cells.lo[1]; y <= job.cells.hi[1]; ++y) {
            const auto number = static_cast<std::size_t>(y + kBrickSide * z);
            const double across =
                job.squares[1][static_cast<std::size_t>(y)] + job.squares[2][static_cast<std::size_t>(z)];
            const unsigned row = job.known.row(job.cells, y, z);
            unsigned kept = 0;
            for (std::size_t x = 0; x < kSide && row != 0 && across < job.within; x += lanes) {
                const DoubleV square = hn::Add(all(across), hn::LoadU(d, job.squares[0].data() + x));
                hn::Store(square, d, out.lo.data() + number * kSide + x);
                kept |= bitsOf(hn::Lt(square, all(job.within))) << x;
            }
            out.kept[number] = static_cast<std::uint8_t>(kept & row);
        }
    }
}

/// The number of the highest bit of each, which is not 0 and less than 256: the exponent of a double.
HWY_INLINE DoubleV highestBit(hn::Vec<hn::Rebind<std::int32_t, Doubles>> bits) {
    constexpr double kTwo52 = 0x1p52;
    constexpr double kBias = 1023;
    const Doubles d;
    const hn::RebindToUnsigned<Doubles> whole;
    const auto exponent = hn::ShiftRight<52>(hn::BitCast(whole, hn::PromoteTo(d, bits)));
    return hn::Sub(hn::BitCast(d, hn::Or(exponent, hn::BitCast(whole, all(kTwo52)))), all(kTwo52 + kBias));
}

double leastCell(const BrickCells& known, const CellBox& cells, const glm::dvec3& along) {
    const Doubles d;
    const hn::Rebind<std::int32_t, Doubles> ints;
    const hn::Rebind<std::uint8_t, Doubles> bytes;
    const auto columns = hn::Set(ints, static_cast<std::int32_t>(cells.columns()));
    DoubleV least = all(kInfinity);
    for (std::int32_t z = cells.lo[2]; z <= cells.hi[2]; ++z) {
        for (std::size_t first = 0; first < kSide; first += hn::Lanes(d)) {
            const std::uint8_t* rows = known.mayBeOpaque.data() + static_cast<std::size_t>(z) * kSide + first;
            const auto row = hn::And(hn::PromoteTo(ints, hn::LoadU(bytes, rows)), columns);
            const DoubleV x = highestBit(along.x >= 0 ? hn::And(row, hn::Neg(row)) : row);
            const DoubleV y = hn::Iota(d, static_cast<double>(first));
            const DoubleM inside =
                hn::And(hn::And(hn::Ge(y, all(cells.lo[1])), hn::Le(y, all(cells.hi[1]))), hn::Ge(x, hn::Zero(d)));
            const DoubleV at = hn::Add(hn::Add(hn::Mul(all(along.x), x), hn::Mul(all(along.y), y)), all(along.z * z));
            least = hn::IfThenElse(inside, lesser(at, least), least);
        }
    }
    return leastOf(least);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxtact::cpu {

HWY_EXPORT(cullCells);
HWY_EXPORT(cullNear);
HWY_EXPORT(leastCell);

void cullCells(const CellCullingJob& job, RemainingCells& out) {
    HWY_DYNAMIC_DISPATCH(cullCells)(job, out);
}

void cullNear(const NearCellsJob& job, RemainingCells& out) {
    HWY_DYNAMIC_DISPATCH(cullNear)(job, out);
}

double leastCell(const BrickCells& known, const CellBox& cells, const glm::dvec3& along) {
    return HWY_DYNAMIC_DISPATCH(leastCell)(known, cells, along);
}

} // namespace voxtact::cpu
#endif
