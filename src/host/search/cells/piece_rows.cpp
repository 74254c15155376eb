// SPDX-License-Identifier: MIT
#include "host/search/cells/piece_rows.h"
#include "core/base/infinity.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/search/cells/piece_rows.cpp"
#include <hwy/foreach_target.h>

#include "host/search/cells/simd_piece.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace {

using Row = PieceRows::Row;

struct TermsV {
    DoubleV of[8];
};

/// Calls `visit(even, odd)` for the pairs that differ along each axis, axis by axis.
template <class Visit> HWY_INLINE void alongAxes(TermsV& terms, const Visit& visit) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < 8; ++i) {
            if ((i >> axis & 1U) == 0) {
                visit(axis, terms.of[i], terms.of[i | std::size_t{1} << axis]);
            }
        }
    }
}

HWY_INLINE DoubleV rowAt(const Row& row, std::size_t first) {
    return hn::Load(Doubles(), row.data() + first);
}

HWY_INLINE PointV pointsAt(const std::array<Row, 3>& rows, std::size_t first) {
    return {rowAt(rows[0], first), rowAt(rows[1], first), rowAt(rows[2], first)};
}

HWY_INLINE TermsV termsAt(const PieceRows& rows, std::size_t first) {
    TermsV out;
    for (std::size_t i = 0; i < 8; ++i) {
        out.of[i] = rowAt(rows.terms[i], first);
    }
    return out;
}

/// within()
HWY_INLINE TermsV pieceTermsAt(const PieceRows& rows, std::size_t first) {
    TermsV terms = termsAt(rows, first);
    const DoubleV middle[3] = {rowAt(rows.middle[0], first), rowAt(rows.middle[1], first),
                               rowAt(rows.middle[2], first)};
    const DoubleV half[3] = {rowAt(rows.half[0], first), rowAt(rows.half[1], first), rowAt(rows.half[2], first)};
    alongAxes(terms, [&](std::size_t axis, DoubleV& even, DoubleV& odd) {
        even = hn::Add(even, hn::Mul(middle[axis], odd));
        odd = hn::Mul(odd, half[axis]);
    });
    return terms;
}

/// Vectorised OpaquePart::cell().
void makeTerms(PieceRows& rows) {
    const Doubles d;
    const DoubleV half = all(0.5);
    for (std::size_t first = 0; first < rows.count; first += hn::Lanes(d)) {
        TermsV terms = termsAt(rows, first);
        DoubleV lo = terms.of[0];
        DoubleV hi = terms.of[0];
        for (const DoubleV& term : terms.of) {
            lo = lesser(term, lo);
            hi = greater(term, hi);
        }
        const DoubleV error = hn::Mul(all(kValueError), greater(hn::Abs(lo), hn::Abs(hi)));
        hn::Store(hn::IfThenElseZero(hn::Lt(lo, hi), error), d, rows.error.data() + first);
        alongAxes(terms, [&](std::size_t /*axis*/, DoubleV& even, DoubleV& odd) {
            const DoubleV lower = even;
            even = hn::Mul(hn::Add(lower, odd), half);
            odd = hn::Mul(hn::Sub(odd, lower), half);
        });
        for (std::size_t i = 0; i < 8; ++i) {
            hn::Store(terms.of[i], d, rows.terms[i].data() + first);
        }
    }
}

/// Vectorised constructor of CellPiece.
void findRanges(PieceRows& rows) {
    const Doubles d;
    for (std::size_t first = 0; first < rows.count; first += hn::Lanes(d)) {
        TermsV corners = pieceTermsAt(rows, first);
        alongAxes(corners, [&](std::size_t /*axis*/, DoubleV& even, DoubleV& odd) {
            const DoubleV centre = even;
            even = hn::Sub(centre, odd);
            odd = hn::Add(centre, odd);
        });
        DoubleV lo = corners.of[0];
        DoubleV hi = corners.of[0];
        DoubleV sum = corners.of[0]; // NaN where a corner is
        for (std::size_t i = 1; i < 8; ++i) {
            lo = lesser(corners.of[i], lo);
            hi = greater(corners.of[i], hi);
            sum = hn::Add(sum, corners.of[i]);
        }
        const DoubleV error = rowAt(rows.error, first);
        const DoubleM known = hn::Eq(sum, sum);
        hn::Store(hn::IfThenElse(known, hn::Sub(lo, error), sum), d, rows.lo.data() + first);
        hn::Store(hn::IfThenElse(known, hn::Add(hi, error), sum), d, rows.hi.data() + first);
    }
}

/// CellPiece::bounds()
HWY_INLINE PieceV boundsAt(const PieceRows& rows, const VolumeSpace& space, std::size_t first) {
    const TermsV terms = pieceTermsAt(rows, first);
    const auto size = [&](std::size_t i) { return hn::Abs(terms.of[i]); };
    const DoubleV bent =
        hn::Add(hn::Add(hn::Add(hn::Add(size(3), size(5)), size(6)), size(7)), rowAt(rows.error, first));
    const DoubleV half = all(0.5);
    const DoubleV one = all(1.0);
    const DoubleV hullLo = rowAt(rows.hullLo, first);
    const DoubleV hullHi = rowAt(rows.hullHi, first);
    const PointV slope{terms.of[1], terms.of[2], terms.of[4]};
    const PointV middle = pointsAt(rows.cell, first) + half * pointsAt(rows.middle, first);
    return {times(space.local_from_voxel, middle),
            half * pointsAt(rows.half, first),
            slope,
            {hn::Div(one, slope.x), hn::Div(one, slope.y), hn::Div(one, slope.z)},
            hn::IfThenElse(hn::Gt(hullLo, rowAt(rows.lo, first)), hn::Sub(hn::Sub(hullLo, bent), terms.of[0]),
                           all(-kInfinity)),
            hn::IfThenElse(hn::Lt(hullHi, rowAt(rows.hi, first)), hn::Sub(hn::Add(hullHi, bent), terms.of[0]),
                           all(kInfinity)),
            sum(abs(slope))};
}

/// In each lane, the farthest of some points along the normal.
struct FarthestV {
    DoubleV along;
    PointV corner;
};

HWY_INLINE FarthestV farthestOf(const PointList& corners, const PointV& normal) {
    const Doubles d;
    const DoubleV one = all(1.0);
    DoubleV along = all(-kInfinity);
    DoubleV number = hn::Zero(d);
    DoubleV farthest = hn::Zero(d);
    for (std::size_t i = 0; i < corners.count; ++i) {
        const PointV corner{all(corners.x[i]), all(corners.y[i]), all(corners.z[i])};
        const DoubleV its = dot(normal, corner);
        const DoubleM farther = hn::Gt(its, along);
        along = hn::IfThenElse(farther, its, along);
        farthest = hn::IfThenElse(farther, number, farthest);
        number = hn::Add(number, one);
    }
    const auto at = hn::ConvertTo(hn::Rebind<std::int64_t, Doubles>(), farthest);
    return {along,
            {hn::GatherIndex(d, corners.x.data(), at), hn::GatherIndex(d, corners.y.data(), at),
             hn::GatherIndex(d, corners.z.data(), at)}};
}

/// Distance along one direction per lane.
HWY_INLINE DoubleV apartAlong(const PieceJob& job, const PieceV& pieces, const PointV& normal, DoubleV farthest) {
    return apart(leastOf(pieces, job.space, normal), farthest, normal, job.error);
}

HWY_INLINE DoubleV apartAlong(const PieceJob& job, const PieceV& pieces, const PointV& normal) {
    DoubleV farthest = all(-kInfinity);
    for (std::size_t i = 0; i < job.corners.count; ++i) {
        const PointV corner{all(job.corners.x[i]), all(job.corners.y[i]), all(job.corners.z[i])};
        farthest = greater(dot(normal, corner), farthest);
    }
    return apartAlong(job, pieces, normal, farthest);
}

/// Returns the direction from about the closest point of the triangles' hull to a piece, given a direction from one of
/// its points along which `farthest` is the farthest corner: uses the closest point of the segment between the two, as
/// in the algorithm of Gilbert, Johnson and Keerthi (1988).
HWY_INLINE PointV refined(const PieceV& pieces, const PointV& normal, const PointV& farthest) {
    const PointV side = farthest - (pieces.middle - normal);
    const DoubleV square = dot(side, side);
    const DoubleV inverse = hn::IfThenElseZero(hn::Gt(square, hn::Zero(Doubles())), hn::Div(all(1.0), square));
    return offSegment(normal, side, inverse);
}

/// True if a piece is large for its distance, so that directions to its points differ.
HWY_INLINE DoubleM isNear(const VolumeSpace& space, const PieceV& pieces, const PointV& normal) {
    constexpr double kHalves = 10;
    const PointV half = all(space.spacing) * pieces.half;
    return hn::Lt(dot(normal, normal), hn::Mul(dot(half, half), all(kHalves * kHalves)));
}

void findApart(const PieceJob& job, PieceRows& rows) {
    const Doubles d;
    const PlacedTriangle nearest = job.triangles.triangle(job.nearest);
    const TriangleV triangle{all(nearest.corners[0]), all(nearest.corners[1]), all(nearest.corners[2])};
    const auto& inverses = job.triangles.inverses;
    const InverseV inverse{all(inverses[0][job.nearest]), all(inverses[1][job.nearest]), all(inverses[2][job.nearest]),
                           all(inverses[3][job.nearest])};
    const DoubleV zero = hn::Zero(d);
    for (std::size_t first = 0; first < rows.count; first += hn::Lanes(d)) {
        const PieceV pieces = boundsAt(rows, job.space, first);
        const PointV normal = offTriangle(triangle, inverse, pieces.middle);
        const FarthestV far = farthestOf(job.corners, normal);
        DoubleV lo = apartAlong(job, pieces, normal, far.along);
        // The result of a piece must not depend on its neighbours in a vector.
        DoubleM left = hn::Lt(lo, all(job.cut));
        if (!hn::AllFalse(d, left)) {
            lo = hn::IfThenElse(left, greater(apartAlong(job, pieces, refined(pieces, normal, far.corner)), lo), lo);
            left = hn::And(left, hn::Lt(lo, all(job.cut)));
            left = hn::And(left, isNear(job.space, pieces, normal));
        }
        if (!hn::AllFalse(d, left)) {
            // Direction of steepest ascent of the interpolant.
            const PointV gradient{hn::Div(pieces.slope.x, pieces.half.x), hn::Div(pieces.slope.y, pieces.half.y),
                                  hn::Div(pieces.slope.z, pieces.half.z)};
            const PointV ascent = times(gradient, job.space.voxel_from_local);
            const PointV other = choose(hn::Lt(dot(ascent, normal), zero), all(glm::dvec3(0)) - ascent, ascent);
            lo = hn::IfThenElse(left, greater(apartAlong(job, pieces, other), lo), lo);
        }
        hn::Store(lo, d, rows.apart.data() + first);
    }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxtact::cpu {

HWY_EXPORT(makeTerms);
HWY_EXPORT(findRanges);
HWY_EXPORT(findApart);

void PieceRows::add(const PartCell& of, const PiecePlace& place) noexcept {
    const double scale = std::ldexp(1.0, -place.depth);
    for (std::size_t i = 0; i < 8; ++i) {
        terms[i][count] = of.terms[i];
    }
    error[count] = of.error;
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        cell[i][count] = of.middle[axis];
        middle[i][count] = of.domain[axis] + ((2.0 * place.piece[i] + 1) * scale - 1) * of.half[axis];
        half[i][count] = scale * of.half[axis];
    }
    ++count;
}

void makeTerms(PieceRows& rows) {
    HWY_DYNAMIC_DISPATCH(makeTerms)(rows);
}

void findRanges(PieceRows& rows) {
    HWY_DYNAMIC_DISPATCH(findRanges)(rows);
}

void findApart(const PieceJob& job, PieceRows& rows) {
    HWY_DYNAMIC_DISPATCH(findApart)(job, rows);
}

} // namespace voxtact::cpu
#endif
