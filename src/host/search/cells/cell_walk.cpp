// SPDX-License-Identifier: MIT
#include "host/search/cells/cell_walk.h"
#include "core/base/infinity.h"

#include <algorithm>
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/search/cells/cell_walk.cpp"
#include <hwy/foreach_target.h>

#include "host/search/cells/simd_space.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace {

using Lanes = std::array<double, kMostDoubles>;

HWY_INLINE PointV pointsAt(const std::array<PieceRows::Row, 3>& rows, std::size_t first) {
    const Doubles d;
    return {hn::Load(d, rows[0].data() + first), hn::Load(d, rows[1].data() + first),
            hn::Load(d, rows[2].data() + first)};
}

/// Some cells.
struct CellsV {
    DoubleV terms[8];
    DoubleV error;
};

HWY_INLINE CellsV cellsAt(const PieceRows& rows, std::size_t first) {
    const Doubles d;
    CellsV out;
    for (std::size_t i = 0; i < 8; ++i) {
        out.terms[i] = hn::Load(d, rows.terms[i].data() + first);
    }
    out.error = hn::Load(d, rows.error.data() + first);
    return out;
}

HWY_INLINE DoubleV onLine(DoubleV at, DoubleV even, DoubleV odd) {
    return hn::Add(even, hn::Mul(at, odd));
}

/// valueAt()
HWY_INLINE DoubleV valuesAt(const CellsV& cells, const PointV& at) {
    const auto& t = cells.terms;
    const DoubleV lower = onLine(at.y, onLine(at.x, t[0], t[1]), onLine(at.x, t[2], t[3]));
    const DoubleV upper = onLine(at.y, onLine(at.x, t[4], t[5]), onLine(at.x, t[6], t[7]));
    return onLine(at.z, lower, upper);
}

/// gradientAt()
HWY_INLINE PointV gradientsAt(const CellsV& cells, const PointV& at) {
    const auto& t = cells.terms;
    const DoubleV xyz = t[7];
    return {onLine(at.z, onLine(at.y, t[1], t[3]), onLine(at.y, t[5], xyz)),
            onLine(at.z, onLine(at.x, t[2], t[3]), onLine(at.x, t[6], xyz)),
            onLine(at.y, onLine(at.x, t[4], t[5]), onLine(at.x, t[6], xyz))};
}

/// Active walks: those that have arrived, and the missing value elsewhere.
struct WalkState {
    unsigned arrived = 0;
    unsigned left = 0;
    DoubleV missing;
};

HWY_INLINE WalkState stateOf(const OpaqueIntervals& intervals, DoubleV value, DoubleV error, unsigned walking) {
    constexpr double kBeyond = 1.5;
    const Doubles d;
    alignas(kRowAlignment) Lanes values;
    alignas(kRowAlignment) Lanes errors;
    alignas(kRowAlignment) Lanes missing{};
    hn::Store(value, d, values.data());
    hn::Store(error, d, errors.data());
    WalkState out;
    for (; walking != 0; walking &= walking - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(walking));
        const unsigned bit = 1U << i;
        if (intervals.contain(values[i] - errors[i], values[i] + errors[i])) {
            out.arrived |= bit;
        } else if (!std::isnan(values[i]) && !intervals.inner().empty()) {
            const ValueRange& target = intervals.nearest(values[i]);
            const double lowest = target.lo + kBeyond * errors[i];
            const double highest = target.hi - kBeyond * errors[i];
            const double wanted =
                lowest <= highest ? std::clamp(values[i], lowest, highest) : 0.5 * (target.lo + target.hi);
            missing[i] = wanted - values[i];
            out.left |= bit;
        }
    }
    out.missing = hn::Load(d, missing.data());
    return out;
}

HWY_INLINE PointV clamped(const PointV& at, const PointV& lo, const PointV& hi) {
    return lesser(greater(at, lo), hi);
}

void walkToOpaque(const WalkJob& job, const PieceRows& rows, WalkRows& out) {
    constexpr int kMostSteps = 4;
    const Doubles d;
    const std::size_t lanes = hn::Lanes(d);
    const DoubleV two = all(2.0);
    const DoubleV half = all(0.5);
    for (std::size_t first = 0; first < rows.count; first += lanes) {
        const CellsV cells = cellsAt(rows, first);
        const PointV middle = pointsAt(rows.cell, first);
        const PointV lo = pointsAt(rows.middle, first) - pointsAt(rows.half, first);
        const PointV hi = pointsAt(rows.middle, first) + pointsAt(rows.half, first);
        PointV at = clamped(two * (all(job.voxel) - middle), lo, hi);
        const std::size_t count = rows.count - first < lanes ? rows.count - first : lanes;
        unsigned walking = (1U << count) - 1;
        unsigned arrived = 0;
        for (int step = 0;; ++step) {
            const DoubleV value = valuesAt(cells, at);
            const WalkState state = stateOf(job.intervals, value, cells.error, walking);
            arrived |= state.arrived;
            if (step == kMostSteps || state.left == 0) {
                break;
            }
            const PointV gradient = two * gradientsAt(cells, at);
            const PointV direction = times(job.space.direction_from_gradient, gradient);
            const DoubleV slope = dot(gradient, direction);
            const DoubleM goes = hn::And(maskOf(state.left), hn::Gt(slope, hn::Zero(d)));
            walking = bitsOf(goes);
            const DoubleV way = hn::Div(hn::Mul(two, state.missing), slope);
            at = choose(goes, clamped(at + way * direction, lo, hi), at);
        }
        const PointV off = times(job.space.local_from_voxel, middle + half * at) - all(job.from);
        const DoubleV distance = hn::Sqrt(dot(off, off));
        hn::Store(hn::IfThenElse(maskOf(arrived), distance, all(kInfinity)), d, out.distance.data() + first);
        hn::Store(at.x, d, out.at[0].data() + first);
        hn::Store(at.y, d, out.at[1].data() + first);
        hn::Store(at.z, d, out.at[2].data() + first);
    }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxtact::cpu {

HWY_EXPORT(walkToOpaque);

void walkToOpaque(const WalkJob& job, const PieceRows& cells, WalkRows& out) {
    HWY_DYNAMIC_DISPATCH(walkToOpaque)(job, cells, out);
}

} // namespace voxtact::cpu
#endif
