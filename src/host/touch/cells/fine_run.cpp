// SPDX-License-Identifier: MIT
#include "host/touch/cells/fine_run.h"

#include "exact/certified_overlap.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/touch/cells/fine_run.cpp"
#include <hwy/foreach_target.h>

#include "host/touch/cells/simd_rows.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace {

using Floats = RowFloats;
using FloatV = RowV;
using Words = hn::RebindToUnsigned<Floats>;
using WordV = hn::Vec<Words>;
using Mask = hn::Mask<Floats>;

HWY_INLINE FloatV leastOf(const std::array<FloatV, 3>& of) {
    return hn::Min(of[0], hn::Min(of[1], of[2]));
}
HWY_INLINE FloatV greatestOf(const std::array<FloatV, 3>& of) {
    return hn::Max(of[0], hn::Max(of[1], of[2]));
}

/// Corners of some triangles, by axis, with their margins.
struct Corners {
    std::array<std::array<FloatV, 3>, 3> at; ///< by axis and corner
    std::array<FloatV, 3> lo;
    std::array<FloatV, 3> hi;
    FloatV delta;
    Mask certain; ///< all is a number, and delta small enough
};

/// Same as certifiedReach() for finite numbers.
HWY_INLINE Corners cornersOf(const FineRun::Triangles& lanes, std::size_t i) {
    const Floats d;
    Corners corners;
    FloatV side = hn::Zero(d);
    FloatV farthest = hn::Zero(d);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        auto& at = corners.at[axis];
        for (std::size_t corner = 0; corner < 3; ++corner) {
            at[corner] = hn::LoadU(d, lanes.at[corner][axis].data() + i);
            farthest = hn::Add(farthest, hn::Abs(at[corner])); // NaN if one is NaN
        }
        corners.lo[axis] = leastOf(at);
        corners.hi[axis] = greatestOf(at);
        side = hn::Max(side, hn::Abs(hn::Sub(corners.hi[axis], corners.lo[axis])));
    }
    std::array<FloatV, 3> error;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        error[corner] = hn::LoadU(d, lanes.error[corner].data() + i);
    }
    const FloatV errors = hn::Add(hn::Add(error[0], error[1]), error[2]);
    const FloatV shift = hn::Mul(hn::Set(d, CERTIFIED_CLIP_ERROR), hn::Add(side, hn::Set(d, 2.0F)));
    corners.delta = hn::Add(greatestOf(error), shift);
    const FloatV most = hn::Set(d, CERTIFIED_FARTHEST);
    corners.certain = hn::And(hn::And(hn::Le(errors, most), hn::Le(farthest, most)),
                              hn::Le(corners.delta, hn::Set(d, CERTIFIED_OVERLAP_DELTA)));
    return corners;
}

/// The cells of an axis, as certifiedCells() has them.
struct Along {
    FloatV first;
    FloatV last;
    Mask some; ///< there are cells
    Mask two;  ///< exactly two of them
    Mask few;  ///< there are no more than two
};

HWY_INLINE Along cellsAlong(const Corners& corners, std::size_t axis, std::int32_t size) {
    const Floats d;
    const FloatV zero = hn::Zero(d);
    const FloatV one = hn::Set(d, 1.0F);
    const FloatV end = hn::Set(d, static_cast<float>(size - 1));
    const FloatV from = hn::Sub(corners.lo[axis], corners.delta);
    const FloatV to = hn::Add(corners.hi[axis], corners.delta);
    Along along;
    along.some = hn::And(hn::Ge(to, hn::Set(d, -0.5F)), hn::Le(from, hn::Set(d, static_cast<float>(size) - 0.5F)));
    along.first = hn::IfThenElse(hn::Ge(from, zero), hn::Min(hn::Trunc(from), end), hn::Neg(one));
    along.last = hn::IfThenElse(hn::Ge(to, zero), hn::Min(hn::Trunc(to), end), hn::Neg(one));
    along.two = hn::Gt(along.last, along.first);
    along.few = hn::Le(hn::Sub(along.last, along.first), one);
    return along;
}

/// Bit of a corner's cell, for the axes tested so far, and whether that cell exists.
struct InCells {
    WordV bits;
    Mask inside;
};

/// Takes one axis into account: the second cell along it has its bit kShift higher than the first.
template <int kShift> HWY_INLINE void narrow(const Along& along, FloatV at, InCells& in) {
    const Floats d;
    const Words words;
    const Mask second = hn::And(along.two, hn::Ge(at, along.last));
    const FloatV beyond = hn::Sub(at, hn::IfThenElse(second, along.last, along.first));
    in.inside = hn::And(in.inside, hn::And(hn::Ge(beyond, hn::Zero(d)), hn::Le(beyond, hn::Set(d, 1.0F))));
    in.bits = hn::IfThenElse(hn::RebindMask(words, second), hn::ShiftLeft<kShift>(in.bits), in.bits);
}

/// The bits of all cells, likewise.
template <int kShift> HWY_INLINE WordV widen(const Along& along, WordV cells) {
    const Words words;
    return hn::IfThenElse(hn::RebindMask(words, along.two), hn::Or(cells, hn::ShiftLeft<kShift>(cells)), cells);
}

using Whole = hn::RebindToSigned<Floats>;
using Bricks = std::array<std::int32_t, 3>;

/// Keeps where the first cell is: in the volume, and in its brick.
HWY_INLINE void keepPlace(const std::array<Along, 3>& along, const Bricks& bricks, FineRun::Triangles& lanes,
                          std::size_t i) {
    const Words words;
    const Whole whole;
    const WordV last = hn::Set(words, kBrickSide - 1);
    std::array<WordV, 3> brick;
    std::array<WordV, 3> within;
    auto oneBrick = hn::Eq(last, last);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto first = hn::ConvertTo(whole, along[axis].first);
        hn::StoreU(first, whole, lanes.first[axis].data() + i);
        const WordV padded = hn::BitCast(words, hn::Add(first, hn::Set(whole, 1)));
        brick[axis] = hn::ShiftRight<kBrickShift>(padded);
        within[axis] = hn::And(padded, last);
        const auto two = hn::RebindMask(words, along[axis].two);
        oneBrick = hn::And(oneBrick, hn::Or(hn::Ne(within[axis], last), hn::Not(two)));
    }
    const auto count = [&](std::size_t axis) { return hn::Set(words, static_cast<std::uint32_t>(bricks[axis])); };
    const WordV number = hn::Add(hn::Mul(hn::Add(hn::Mul(brick[2], count(1)), brick[1]), count(0)), brick[0]);
    hn::StoreU(number, words, lanes.brick.data() + i);
    hn::StoreU(hn::Add(within[1], hn::ShiftLeft<kBrickShift>(within[2])), words, lanes.row.data() + i);
    hn::StoreU(within[0], words, lanes.column.data() + i);
    hn::StoreU(hn::IfThenElseZero(oneBrick, hn::Set(words, 1)), words, lanes.oneBrick.data() + i);
}

HWY_INLINE void lookAtSome(const shader::CertifiedItem& item, const Bricks& bricks, FineRun::Triangles& lanes,
                           std::size_t i) {
    const Floats d;
    const Words words;
    const Corners corners = cornersOf(lanes, i);
    const std::array<Along, 3> along{cellsAlong(corners, 0, item.sizeX), cellsAlong(corners, 1, item.sizeY),
                                     cellsAlong(corners, 2, item.sizeZ)};
    const Mask some = hn::And(hn::And(along[0].some, along[1].some), along[2].some);
    const Mask few = hn::And(hn::And(along[0].few, along[1].few), along[2].few);
    for (std::size_t corner = 0; corner < 3; ++corner) {
        InCells in{hn::Set(words, 1), some};
        narrow<1>(along[0], corners.at[0][corner], in);
        narrow<2>(along[1], corners.at[1][corner], in);
        narrow<4>(along[2], corners.at[2][corner], in);
        const WordV bits = hn::IfThenElseZero(hn::RebindMask(words, in.inside), in.bits);
        hn::StoreU(bits, words, lanes.corner[corner].data() + i);
    }
    const WordV cells = widen<4>(along[2], widen<2>(along[1], widen<1>(along[0], hn::Set(words, 1))));
    const Mask small = hn::And(corners.certain, hn::Or(few, hn::Not(some)));
    hn::StoreU(hn::IfThenElseZero(hn::RebindMask(words, small), hn::Set(words, 1)), words, lanes.small.data() + i);
    hn::StoreU(hn::IfThenElseZero(hn::RebindMask(words, some), cells), words, lanes.cells.data() + i);
    hn::StoreU(corners.delta, d, lanes.delta.data() + i);
    keepPlace(along, bricks, lanes, i);
}

void lookAt(const shader::CertifiedItem& item, const Bricks& bricks, FineRun::Triangles& lanes, std::size_t count) {
    for (std::size_t i = 0; i < count; i += hn::Lanes(Floats())) {
        lookAtSome(item, bricks, lanes, i);
    }
}

struct PointV {
    FloatV x;
    FloatV y;
    FloatV z;
};

HWY_INLINE PointV minus(const PointV& a, const PointV& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
/// Same as voxelLength().
HWY_INLINE FloatV lengthOf(const PointV& of) {
    return hn::Max(hn::Abs(of.x), hn::Max(hn::Abs(of.y), hn::Abs(of.z)));
}
/// a b - c d.
HWY_INLINE FloatV crossed(FloatV a, FloatV b, FloatV c, FloatV d) {
    return hn::Sub(hn::Mul(a, b), hn::Mul(c, d));
}

/// Verdicts on cells, like certifiedSeparate() and related functions for one.
struct Verdict {
    Mask none;
    Mask some;
    FloatV margin; ///< as in certifiedOverlapMargin()

    HWY_INLINE void separate(FloatV gap, FloatV slack, FloatV size) {
        const FloatV most = hn::Mul(margin, size);
        none = hn::Or(none, hn::Gt(hn::Sub(gap, slack), most));
        some = hn::And(some, hn::Le(hn::Add(gap, slack), hn::Neg(most)));
    }
    HWY_INLINE void separate(FloatV a, FloatV b, FloatV c, FloatV size) {
        const Floats d;
        const FloatV least = hn::Min(a, hn::Min(b, c));
        const FloatV greatest = hn::Max(a, hn::Max(b, c));
        const FloatV half = hn::Mul(hn::Set(d, 0.5F), size);
        separate(hn::Sub(hn::Max(least, hn::Neg(greatest)), half), hn::Zero(d), size);
    }
    HWY_INLINE void separateByEdge(const PointV& edge, const PointV& a, const PointV& b, const PointV& c) {
        const FloatV x = hn::Abs(edge.x);
        const FloatV y = hn::Abs(edge.y);
        const FloatV z = hn::Abs(edge.z);
        separate(crossed(edge.z, a.y, edge.y, a.z), crossed(edge.z, b.y, edge.y, b.z),
                 crossed(edge.z, c.y, edge.y, c.z), hn::Add(y, z));
        separate(crossed(edge.x, a.z, edge.z, a.x), crossed(edge.x, b.z, edge.z, b.x),
                 crossed(edge.x, c.z, edge.z, c.x), hn::Add(z, x));
        separate(crossed(edge.y, a.x, edge.x, a.y), crossed(edge.y, b.x, edge.x, b.y),
                 crossed(edge.y, c.x, edge.x, c.y), hn::Add(x, y));
    }
};

/// The triangles of some cells, and the cells' middles.
struct Asked {
    std::array<PointV, 3> corner;
    PointV middle;
    FloatV delta;
};

HWY_INLINE Asked askedOf(const FineRun::Triangles& triangles, const FineRun::Cells& cells, std::size_t i) {
    const Floats d;
    const Whole whole;
    const auto triangle = hn::LoadU(whole, cells.triangle.data() + i);
    const auto number = hn::LoadU(whole, cells.number.data() + i);
    Asked asked;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto& at = triangles.at[corner];
        asked.corner[corner] = {hn::GatherIndex(d, at[0].data(), triangle), hn::GatherIndex(d, at[1].data(), triangle),
                                hn::GatherIndex(d, at[2].data(), triangle)};
    }
    const auto one = hn::Set(whole, 1);
    const auto middle = [&](std::size_t axis, auto second) {
        const auto first = hn::GatherIndex(whole, triangles.first[axis].data(), triangle);
        return hn::Add(hn::ConvertTo(d, hn::Add(first, second)), hn::Set(d, 0.5F));
    };
    asked.middle = {middle(0, hn::And(number, one)), middle(1, hn::And(hn::ShiftRight<1>(number), one)),
                    middle(2, hn::ShiftRight<2>(number))};
    asked.delta = hn::GatherIndex(d, triangles.delta.data(), triangle);
    return asked;
}

/// Same as certifiedOverlap(), for triangles without a corner in the cell.
HWY_INLINE Verdict overlapOf(const Asked& asked) {
    const Floats d;
    const FloatV one = hn::Set(d, 1.0F);
    const auto& [first, second, third] = asked.corner;
    const PointV a = minus(first, asked.middle);
    const PointV b = minus(second, asked.middle);
    const PointV c = minus(third, asked.middle);
    Verdict verdict{hn::Lt(one, one), hn::Eq(one, one), hn::Mul(hn::Set(d, CERTIFIED_OVERLAP_MARGIN), asked.delta)};
    verdict.separate(a.x, b.x, c.x, one);
    verdict.separate(a.y, b.y, c.y, one);
    verdict.separate(a.z, b.z, c.z, one);
    verdict.separateByEdge(minus(b, a), a, b, c);
    verdict.separateByEdge(minus(c, b), a, b, c);
    verdict.separateByEdge(minus(a, c), a, b, c);
    // Same as in certifiedTriangle().
    const PointV u = minus(second, first);
    const PointV v = minus(third, first);
    const PointV normal{crossed(u.y, v.z, u.z, v.y), crossed(u.z, v.x, u.x, v.z), crossed(u.x, v.y, u.y, v.x)};
    const FloatV side = hn::Max(lengthOf(u), hn::Max(lengthOf(v), lengthOf(minus(third, second))));
    const FloatV reach = hn::Add(side, hn::Set(d, 2.0F));
    const FloatV size = hn::Add(hn::Add(hn::Abs(normal.x), hn::Abs(normal.y)), hn::Abs(normal.z));
    const FloatV slack = hn::Mul(hn::Mul(hn::Mul(reach, reach), hn::Add(reach, one)), hn::Set(d, CERTIFIED_CLIP_ERROR));
    const FloatV distance =
        hn::Abs(hn::Add(hn::Add(hn::Mul(normal.x, a.x), hn::Mul(normal.y, a.y)), hn::Mul(normal.z, a.z)));
    verdict.separate(hn::Sub(distance, hn::Mul(hn::Set(d, 0.5F), size)), slack, size);
    return verdict;
}

void answerTo(const FineRun::Triangles& triangles, FineRun::Cells& cells, std::size_t count) {
    const Words words;
    const WordV one = hn::Set(words, 1);
    for (std::size_t i = 0; i < count; i += hn::Lanes(words)) {
        const Verdict verdict = overlapOf(askedOf(triangles, cells, i));
        const auto none = hn::RebindMask(words, verdict.none);
        const auto some = hn::AndNot(none, hn::RebindMask(words, verdict.some));
        hn::StoreU(hn::IfThenElseZero(none, one), words, cells.none.data() + i);
        hn::StoreU(hn::IfThenElseZero(some, one), words, cells.some.data() + i);
    }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxtact::cpu {

HWY_EXPORT(lookAt);
HWY_EXPORT(answerTo);

static_assert(FineRun::kMost % kBrickSide == 0, "vectors have no more lanes than that");

void FineRun::add(const shader::CertifiedVertex& a, const shader::CertifiedVertex& b,
                  const shader::CertifiedVertex& c) noexcept {
    std::size_t corner = 0;
    for (const shader::CertifiedVertex* const vertex : {&a, &b, &c}) {
        triangles_.at[corner][0][count_] = vertex->point.x;
        triangles_.at[corner][1][count_] = vertex->point.y;
        triangles_.at[corner][2][count_] = vertex->point.z;
        triangles_.error[corner][count_] = vertex->error;
        ++corner;
    }
    ++count_;
}

void FineRun::test(const shader::CertifiedItem& item, const std::array<std::int32_t, 3>& bricks) noexcept {
    HWY_DYNAMIC_DISPATCH(lookAt)(item, bricks, triangles_, count_);
    count_ = 0;
    asked_ = 0;
}

void FineRun::ask(std::size_t i, unsigned cells) noexcept {
    overlaps_[i] = {};
    for (; cells != 0; cells &= cells - 1) {
        cells_.triangle[asked_] = static_cast<std::int32_t>(i);
        cells_.number[asked_] = std::countr_zero(cells);
        ++asked_;
    }
}

void FineRun::answer() noexcept {
    HWY_DYNAMIC_DISPATCH(answerTo)(triangles_, cells_, asked_);
    for (std::size_t i = 0; i < asked_; ++i) {
        Overlap& overlap = overlaps_[static_cast<std::size_t>(cells_.triangle[i])];
        overlap.some |= cells_.some[i] << static_cast<unsigned>(cells_.number[i]);
        overlap.none |= cells_.none[i] << static_cast<unsigned>(cells_.number[i]);
    }
}

} // namespace voxtact::cpu
#endif
