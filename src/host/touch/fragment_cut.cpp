// SPDX-License-Identifier: MIT
#include "host/touch/fragment_filter.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/touch/fragment_cut.cpp"
#include <hwy/foreach_target.h>

#include "host/touch/simd_fragments.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace {

using Point = std::array<FragmentV, 3>;

HWY_INLINE Point either(FragmentMask mask, const Point& yes, const Point& no) {
    return {hn::IfThenElse(mask, yes[0], no[0]), hn::IfThenElse(mask, yes[1], no[1]),
            hn::IfThenElse(mask, yes[2], no[2])};
}

/// The outline of a polygon: its edges, in no order, each from a corner to the next.
struct Outline {
    static constexpr std::size_t kMost = CERTIFIED_MAX_CORNERS;

    std::array<Point, kMost> from;
    std::array<Point, kMost> to;
    std::array<FragmentMask, kMost> some; ///< there is such an edge
    std::size_t count = 3;
    /// A side of the cell cuts it more than twice. That would take a polygon which rounding has bent; none was ever
    /// seen.
    FragmentMask irregular;
};

/// Cuts off the part beyond a side of the cell, like certifiedClipPlane(). The edge along the side comes last.
HWY_INLINE void cut(std::size_t axis, bool above, FragmentV limit, Outline& outline) {
    const FragmentFloats d;
    const FragmentV zero = hn::Zero(d);
    const FragmentMask never = hn::Lt(zero, zero);
    Point leaves{zero, zero, zero};
    Point enters = leaves;
    FragmentMask left = never;
    FragmentMask entered = never;
    for (std::size_t i = 0; i < outline.count; ++i) {
        Point& from = outline.from[i];
        Point& to = outline.to[i];
        const auto distance = [&](const Point& at) {
            return above ? hn::Sub(at[axis], limit) : hn::Sub(limit, at[axis]);
        };
        const FragmentV ofFrom = distance(from);
        const FragmentV ofTo = distance(to);
        const FragmentMask isFrom = hn::Ge(ofFrom, zero);
        const FragmentMask isTo = hn::Ge(ofTo, zero);
        const FragmentMask out = hn::And(outline.some[i], hn::AndNot(isTo, isFrom));
        const FragmentMask in = hn::And(outline.some[i], hn::AndNot(isFrom, isTo));
        if (!hn::AllFalse(d, hn::Or(out, in))) {
            const FragmentV inside = hn::IfThenElse(out, ofFrom, ofTo);
            const FragmentV outside = hn::IfThenElse(out, ofTo, ofFrom);
            const FragmentV weight = hn::Mul(inside, reciprocal(d, hn::Sub(inside, outside)));
            const Point start = either(out, from, to);
            const Point end = either(out, to, from);
            const Point at{lerp(start[0], end[0], weight), lerp(start[1], end[1], weight),
                           lerp(start[2], end[2], weight)};
            outline.irregular = hn::Or(outline.irregular, hn::Or(hn::And(out, left), hn::And(in, entered)));
            left = hn::Or(left, out);
            entered = hn::Or(entered, in);
            leaves = either(out, at, leaves);
            enters = either(in, at, enters);
            to = either(out, at, to);
            from = either(in, at, from);
        }
        outline.some[i] = hn::And(outline.some[i], hn::Or(isFrom, isTo));
    }
    outline.from[outline.count] = leaves;
    outline.to[outline.count] = enters;
    outline.some[outline.count] = left;
    ++outline.count;
}

/// Fragments that are anywhere among the lanes.
struct Scattered {
    const FragmentFilter::Lanes& lanes;
    hn::Vec<FragmentWhole> number;

    [[nodiscard]] HWY_INLINE FragmentV of(const FragmentFilter::Lanes::Each<float>& each) const {
        return hn::GatherIndex(FragmentFloats(), each.data(), number);
    }
    [[nodiscard]] HWY_INLINE AlongCell cell(std::size_t axis, std::int32_t size) const {
        return alongCell(hn::GatherIndex(FragmentWhole(), lanes.cell[axis].data(), number), size);
    }
};

using Cells = std::array<AlongCell, 3>;

/// Same as certifiedClip(), except for the order of the corners.
HWY_INLINE Outline clipped(const Scattered& fragments, const Cells& cells, FragmentV delta) {
    const FragmentFloats d;
    Outline outline;
    outline.irregular = hn::Lt(hn::Zero(d), hn::Zero(d));
    for (std::size_t corner = 0; corner < 3; ++corner) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            outline.from[corner][axis] =
                hn::Sub(fragments.of(fragments.lanes.triangle[corner][axis]), cells[axis].place);
        }
        outline.some[corner] = hn::Eq(hn::Zero(d), hn::Zero(d));
    }
    for (std::size_t corner = 0; corner < 3; ++corner) {
        outline.to[corner] = outline.from[corner < 2 ? corner + 1 : 0];
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        cut(axis, true, hn::Sub(cells[axis].lo, delta), outline);
        cut(axis, false, hn::Add(cells[axis].hi, delta), outline);
    }
    return outline;
}

/// The corners, moved into the cells as certifiedClip() does.
HWY_INLINE void clampCorners(const Cells& cells, Outline& outline) {
    for (std::size_t i = 0; i < outline.count; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            FragmentV& at = outline.from[i][axis];
            at = clamped(at, cells[axis].lo, cells[axis].hi);
        }
    }
}

/// Boxes around the corners; arbitrary without corners.
HWY_INLINE FragmentBoxes boxesOf(const Cells& cells, const Outline& outline) {
    FragmentBoxes boxes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        FragmentV lo = cells[axis].hi;
        FragmentV hi = cells[axis].lo;
        for (std::size_t i = 0; i < outline.count; ++i) {
            const FragmentV at = outline.from[i][axis];
            lo = hn::IfThenElse(outline.some[i], lesser(lo, at), lo);
            hi = hn::IfThenElse(outline.some[i], greater(hi, at), hi);
        }
        boxes.lo[axis] = lo;
        boxes.hi[axis] = hi;
    }
    return boxes;
}

/// Same as certifiedInterpolate().
HWY_INLINE FragmentV interpolated(const FragmentEntries& entries, const Point& at) {
    const FragmentV v00 = lerp(entries[0], entries[1], at[0]);
    const FragmentV v10 = lerp(entries[2], entries[3], at[0]);
    const FragmentV v01 = lerp(entries[4], entries[5], at[0]);
    const FragmentV v11 = lerp(entries[6], entries[7], at[0]);
    return lerp(lerp(v00, v10, at[1]), lerp(v01, v11, at[1]), at[2]);
}

/// Same as certifiedPointProves() for some corner, in cells entirely inside the domain.
HWY_INLINE FragmentMask someProves(const shader::OpacityBounds& bounds, const FragmentEntries& entries,
                                   FragmentV margin, const Outline& outline) {
    const FragmentFloats d;
    FragmentMask proves = hn::Lt(hn::Zero(d), hn::Zero(d));
    for (std::size_t i = 0; i < outline.count; ++i) {
        const FragmentV entry = interpolated(entries, outline.from[i]);
        proves = hn::Or(proves, hn::And(outline.some[i], allIn(bounds, {entry, entry}, margin)));
    }
    return proves;
}

/// True if there is no corner, or nothing opaque in the box around them. certifiedDecide() uses only means of values in
/// that box: it adds a margin to their range, and the rounding there and here is less than two of a point's errors.
HWY_INLINE FragmentMask hasNone(const shader::OpacityBounds& bounds, const Cells& cells, const FragmentEntries& entries,
                                const FragmentErrors& errors, const Outline& outline) {
    FragmentMask some = outline.some[0];
    for (std::size_t i = 1; i < outline.count; ++i) {
        some = hn::Or(some, outline.some[i]);
    }
    const FragmentV slack = hn::Add(errors.margin, hn::Mul(errors.point, all(2)));
    return hn::Or(hn::Not(some), noneIn(bounds, rangesIn(entries, boxesOf(cells, outline)), slack));
}

HWY_INLINE void cutSome(const shader::CertifiedItem& item, const shader::OpacityBounds& bounds,
                        const std::int32_t* numbers, std::size_t count, FragmentFilter::Lanes& lanes) {
    const FragmentFloats d;
    const FragmentWords words;
    const Scattered fragments{lanes, hn::LoadU(FragmentWhole(), numbers)};
    const Cells cells{fragments.cell(0, item.sizeX), fragments.cell(1, item.sizeY), fragments.cell(2, item.sizeZ)};
    const FragmentV delta = fragments.of(lanes.delta);
    FragmentEntries entries;
    for (std::size_t corner = 0; corner < entries.size(); ++corner) {
        entries[corner] = entryOf(item, fragments.of(lanes.stored[corner]));
    }
    const FragmentErrors errors = errorsOf(item, fragments.of(lanes.wideLo), fragments.of(lanes.wideHi), delta);
    Outline outline = clipped(fragments, cells, delta);
    clampCorners(cells, outline);
    const FragmentMask whole = hn::And(hn::And(cells[0].whole, cells[1].whole), cells[2].whole);
    const FragmentMask certain = hn::And(someProves(bounds, entries, errors.margin, outline), whole);
    const FragmentMask none = hasNone(bounds, cells, entries, errors, outline);
    const auto wordsOf = [&](FragmentMask mask) {
        return hn::IfThenElseZero(hn::RebindMask(words, hn::AndNot(outline.irregular, mask)), hn::Set(words, 1));
    };
    std::array<std::uint32_t, FragmentFilter::kMostLanes> isCertain;
    std::array<std::uint32_t, FragmentFilter::kMostLanes> isNone;
    hn::StoreU(wordsOf(certain), words, isCertain.data());
    hn::StoreU(wordsOf(none), words, isNone.data());
    for (std::size_t lane = 0; lane < hn::Lanes(d) && lane < count; ++lane) {
        lanes.certain[static_cast<std::size_t>(numbers[lane])] = isCertain[lane];
        lanes.none[static_cast<std::size_t>(numbers[lane])] = isNone[lane];
    }
}

void cutAll(const shader::CertifiedItem& item, const shader::OpacityBounds& bounds,
            const FragmentFilter::Chosen& chosen, FragmentFilter::Lanes& lanes) {
    for (std::size_t i = 0; i < chosen.count; i += hn::Lanes(FragmentFloats())) {
        cutSome(item, bounds, chosen.number.data() + i, chosen.count - i, lanes);
    }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxtact::cpu {

HWY_EXPORT(cutAll);

void cutFragments(const shader::CertifiedItem& item, const shader::OpacityBounds& bounds,
                  const FragmentFilter::Chosen& chosen, FragmentFilter::Lanes& lanes) noexcept {
    HWY_DYNAMIC_DISPATCH(cutAll)(item, bounds, chosen, lanes);
}

} // namespace voxtact::cpu
#endif
