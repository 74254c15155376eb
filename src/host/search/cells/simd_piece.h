// SPDX-License-Identifier: MIT
// What is opaque in pieces of cells, for one target: what PieceBounds has of one, of one in each lane.
#if defined(VOXTACT_CPU_SIMD_PIECE_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXTACT_CPU_SIMD_PIECE_H
#undef VOXTACT_CPU_SIMD_PIECE_H
#else
#define VOXTACT_CPU_SIMD_PIECE_H
#endif

#include "host/search/cells/cell_piece.h"
#include "host/search/cells/simd_space.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {

struct PieceV {
    PointV middle, half, slope, inverse;
    DoubleV from, to, size;
};

HWY_INLINE PieceV all(const PieceBounds& piece) {
    return {all(piece.middle), all(piece.half), all(piece.slope), all(piece.inverse),
            all(piece.from),   all(piece.to),   all(piece.size)};
}

/// PieceBounds::least()
HWY_INLINE DoubleV leastOf(const PieceV& piece, const VolumeSpace& space, const PointV& normal) {
    const PointV w = times(normal, space.local_from_voxel) * piece.half;
    const PointV multipliers = w * piece.inverse;
    DoubleV best = hn::Neg(sum(abs(w)));
    for (const DoubleV multiplier : {multipliers.x, multipliers.y, multipliers.z}) {
        const DoubleV plane = hn::IfThenElse(hn::Gt(multiplier, hn::Zero(Doubles())), piece.from, piece.to);
        const PointV left = w - multiplier * piece.slope;
        const DoubleV slack =
            hn::Mul(hn::Mul(all(kSumError), hn::Abs(multiplier)), hn::Add(hn::Abs(plane), piece.size));
        best = greater(hn::Sub(hn::Sub(hn::Mul(multiplier, plane), sum(abs(left))), slack), best);
    }
    return hn::Add(dot(normal, piece.middle), best);
}

} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#endif
