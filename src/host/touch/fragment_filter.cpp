// SPDX-License-Identifier: MIT
#include "host/touch/fragment_filter.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/touch/fragment_filter.cpp"
#include <hwy/foreach_target.h>

#include "host/touch/simd_fragments.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace {

/// Boxes of the triangles' parts, and which cells are whole in the domain.
struct PartBoxes {
    FragmentBoxes boxes;
    FragmentMask whole;
};

/// Same as certifiedPart() along an axis.
HWY_INLINE void setAlong(const FragmentFilter::Lanes& lanes, std::size_t i, std::size_t axis, std::int32_t size,
                         PartBoxes& parts) {
    const FragmentFloats d;
    const AlongCell cell = alongCell(hn::LoadU(FragmentWhole(), lanes.cell[axis].data() + i), size);
    const FragmentV delta = hn::LoadU(d, lanes.delta.data() + i);
    const auto corner = [&](std::size_t of) {
        return hn::Sub(hn::LoadU(d, lanes.triangle[of][axis].data() + i), cell.place);
    };
    const FragmentV a = corner(0);
    const FragmentV b = corner(1);
    const FragmentV c = corner(2);
    parts.boxes.lo[axis] = clamped(hn::Sub(lesser(a, lesser(b, c)), delta), cell.lo, cell.hi);
    parts.boxes.hi[axis] = clamped(hn::Add(greater(a, greater(b, c)), delta), cell.lo, cell.hi);
    parts.whole = hn::And(parts.whole, cell.whole);
}

/// In units of a point's error: one for the range here, one for a polygon's corner, one for rounding.
constexpr float kErrors = 3;

HWY_INLINE void lookAtSome(const shader::CertifiedItem& item, const shader::OpacityBounds& bounds,
                           FragmentFilter::Lanes& lanes, std::size_t i) {
    const FragmentFloats d;
    const FragmentWords words;
    PartBoxes parts;
    parts.whole = hn::Eq(hn::Zero(d), hn::Zero(d));
    setAlong(lanes, i, 0, item.sizeX, parts);
    setAlong(lanes, i, 1, item.sizeY, parts);
    setAlong(lanes, i, 2, item.sizeZ, parts);
    FragmentEntries entries;
    for (std::size_t corner = 0; corner < entries.size(); ++corner) {
        entries[corner] = entryOf(item, hn::LoadU(d, lanes.stored[corner].data() + i));
    }
    const FragmentRanges ranges = rangesIn(entries, parts.boxes);
    const FragmentErrors errors = errorsOf(item, hn::LoadU(d, lanes.wideLo.data() + i),
                                           hn::LoadU(d, lanes.wideHi.data() + i), hn::LoadU(d, lanes.delta.data() + i));
    const FragmentMask none = noneIn(bounds, ranges, errors.point);
    const FragmentV slack = hn::Add(errors.margin, hn::Mul(errors.point, all(kErrors)));
    const FragmentMask opaque = allIn(bounds, ranges, slack);
    const auto certain = hn::RebindMask(words, hn::And(opaque, parts.whole));
    const auto passes = hn::LoadU(words, lanes.passes.data() + i);
    hn::StoreU(hn::IfThenElseZero(hn::RebindMask(words, none), hn::Set(words, 1)), words, lanes.none.data() + i);
    hn::StoreU(hn::IfThenElseZero(certain, passes), words, lanes.certain.data() + i);
}

void lookAtFragments(const shader::CertifiedItem& item, const shader::OpacityBounds& bounds,
                     FragmentFilter::Lanes& lanes, std::size_t count) {
    for (std::size_t i = 0; i < count; i += hn::Lanes(FragmentFloats())) {
        lookAtSome(item, bounds, lanes, i);
    }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxtact::cpu {

HWY_EXPORT(lookAtFragments);

void FragmentFilter::add(const Fragment& fragment) noexcept {
    const std::size_t i = count_++;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const shader::VoxelPoint& at = fragment.triangle[corner];
        lanes_.triangle[corner][0][i] = at.x;
        lanes_.triangle[corner][1][i] = at.y;
        lanes_.triangle[corner][2][i] = at.z;
    }
    lanes_.delta[i] = fragment.delta;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lanes_.cell[axis][i] = fragment.cell[axis];
    }
    const shader::CertifiedCorners& of = fragment.corners;
    std::size_t corner = 0;
    for (const float stored : {of.s000, of.s100, of.s010, of.s110, of.s001, of.s101, of.s011, of.s111}) {
        lanes_.stored[corner++][i] = stored;
    }
    lanes_.wideLo[i] = of.wideLo;
    lanes_.wideHi[i] = of.wideHi;
    lanes_.passes[i] = fragment.passes ? 1 : 0;
}

void FragmentFilter::test(const shader::CertifiedItem& item, const shader::OpacityBounds& bounds) noexcept {
    HWY_DYNAMIC_DISPATCH(lookAtFragments)(item, bounds, lanes_, count_);
    Chosen open;
    for (std::size_t i = 0; i < count_; ++i) {
        open.number[open.count] = static_cast<std::int32_t>(i);
        open.count += (lanes_.none[i] | lanes_.certain[i]) == 0 ? 1 : 0;
    }
    cutFragments(item, bounds, open, lanes_);
    count_ = 0;
}

} // namespace voxtact::cpu
#endif
