// SPDX-License-Identifier: MIT
#include "host/overlap/box_part.h"
#include "core/base/infinity.h"
#include "host/overlap/cube_share.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

/// A function that has more opaque intervals in the range of a box is left for smaller boxes.
constexpr std::size_t kMaxIntervals = 8;
/// A box with a shorter side is not divided again, voxels.
constexpr double kMinSide = 0x1p-24;
/// No sheet is divided into more parts, on average over a box.
constexpr std::uint64_t kMaxParts = 256;
/// Displacing the corners of a sheet by w changes the space behind it by no more than this times w and the box's faces.
constexpr double kFaces = 16;

int longestOf(const dvec3& of) {
    return of.x >= of.y && of.x >= of.z ? 0 : (of.y >= of.z ? 1 : 2);
}

} // namespace

CellPartBox wholeCell(const VolumeImpl& volume, const NodePlace& cell) noexcept {
    CellPartBox box;
    box.cell = cell;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int32_t number = cell[static_cast<std::size_t>(axis)];
        box.lo[axis] = number == 0 ? 0.5 : number;
        box.hi[axis] = number + (number == volume.image.size[static_cast<std::size_t>(axis)] ? 0.5 : 1.0);
    }
    return box;
}

/// The interpolant on a box: between which values it is, and how far from a linear function.
struct BoxMeasure::Values {
    Trilinear cell{}; ///< of the whole cell
    dvec3 cellMiddle{};
    double error = 0;
    double lo = 0;
    double hi = 0;
    double middle = 0; ///< of the linear function
    dvec3 slope{};     ///< a half side along each axis changes it by so much
    double off = 0;    ///< all of `error` included
    dvec3 bent{};      ///< part of it that a division across an axis removes
    dvec3 centre{};
    dvec3 half{};
    Trilinear terms{}; ///< of the box

    void setBox(const dvec3& from, const dvec3& to);
    /// Part of the box between two values, at most `error` apart.
    [[nodiscard]] double thickness() const noexcept {
        const double steepest = std::max({std::abs(slope.x), std::abs(slope.y), std::abs(slope.z)});
        return steepest > 0 ? std::min(1.0, 4 * error / steepest) : 1.0;
    }
};

BoxMeasure::Values BoxMeasure::valuesOn(const CellPartBox& box) const {
    const PartCell cell = part_.cell(volume_, box.cell);
    Values out;
    out.cell = cell.terms;
    out.cellMiddle = {box.cell[0] + 0.5, box.cell[1] + 0.5, box.cell[2] + 0.5};
    out.error = 4 * cell.error;
    out.setBox(box.lo, box.hi);
    return out;
}

void BoxMeasure::Values::setBox(const dvec3& from, const dvec3& to) {
    centre = 0.5 * (from + to);
    half = glm::max(0.5 * (to - from), dvec3(kMinSide)); // a sheet may be a point
    terms = within(cell, 2.0 * (centre - cellMiddle), 2.0 * half);
    std::array<double, 8> values = terms;
    for (const std::size_t axis : {std::size_t{1}, std::size_t{2}, std::size_t{4}}) {
        for (std::size_t i = 0; i < 8; ++i) {
            if ((i & axis) == 0) {
                const double even = values[i];
                values[i] = even - values[i | axis];
                values[i | axis] += even;
            }
        }
    }
    const auto [least, greatest] = std::ranges::minmax(values);
    lo = least - error;
    hi = greatest + error;
    double all = 0; // NaN where a value is
    for (const double value : values) {
        all += value;
    }
    if (!std::isfinite(all)) {
        lo = hi = std::nan("");
    }
    middle = terms[0];
    slope = {terms[1], terms[2], terms[4]};
    const double cubic = std::abs(terms[7]);
    bent = {std::abs(terms[3]) + std::abs(terms[5]) + cubic, std::abs(terms[3]) + std::abs(terms[6]) + cubic,
            std::abs(terms[5]) + std::abs(terms[6]) + cubic};
    off = std::abs(terms[3]) + std::abs(terms[5]) + std::abs(terms[6]) + cubic + 2 * error;
}

BoxMeasure::Share BoxMeasure::shareOf(const CellPartBox& box, const SheetList& sheets, Jump base) const {
    Share all;
    const auto add = [&](double jump, double volume) {
        if (std::abs(jump) > 1) {
            all.unknown += std::abs(volume);
        } else {
            all.volume += jump * volume;
        }
    };
    add(base, box.volume());
    Sheet sheet;
    for (std::size_t i = 0; i < sheets.count(); ++i) {
        sheets.get(i, sheet);
        add(sheet.jump, sheet.volumeTo(box.hi.x));
    }
    const dvec3 side = box.hi - box.lo;
    all.slack =
        kFaces * rounding_ * (side.y * side.z + side.x * (side.y + side.z)) * static_cast<double>(sheets.count() + 1);
    return all;
}

namespace {

/// A corner of a sheet: its place, and its distance to the plane behind it. Uninitialised, to save time.
struct Corner {
    double y;
    double z;
    double depth;
};

/// A corner with the linear values there and on the plane behind it.
struct ValueCorner {
    Corner at;
    double near;
    double far;
};

/// The signed volume behind a polygon, added up corner by corner.
class Fan {
  public:
    void add(const Corner& corner) noexcept {
        if (count_ == 0) {
            first_ = corner;
        } else if (count_ > 1) {
            sum_ += ((last_.y - first_.y) * (corner.z - first_.z) - (last_.z - first_.z) * (corner.y - first_.y)) *
                    (first_.depth + last_.depth + corner.depth);
        }
        last_ = corner;
        ++count_;
    }
    [[nodiscard]] double volume() const noexcept { return sum_ / 6; }

  private:
    Corner first_;
    Corner last_;
    std::uint32_t count_ = 0;
    double sum_ = 0;
};

double volumeBehind(const ValueCorner* corners, std::uint32_t count) noexcept {
    Fan fan;
    std::for_each_n(corners, count, [&](const ValueCorner& corner) { fan.add(corner.at); });
    return fan.volume();
}

/// If the values grow along the path (slope > 0), the whole path counts if it begins at `from` or above, else the part
/// beyond `from`; and vice versa.
double volumeFrom(const ValueCorner* corners, std::uint32_t count, double slope, double from) noexcept {
    const double inverse = 1 / std::abs(slope);
    Fan all;
    Fan part;
    const auto least = [&](const ValueCorner& at) { return (slope > 0 ? at.near : at.far) - from; };
    const auto greatest = [&](const ValueCorner& at) { return (slope > 0 ? at.far : at.near) - from; };
    const auto between = [](const Corner& a, const Corner& b, double heightA, double heightB) {
        const double t = heightA / (heightA - heightB);
        return Corner{a.y + t * (b.y - a.y), a.z + t * (b.z - a.z), a.depth + t * (b.depth - a.depth)};
    };
    const auto addPart = [&](Corner at, double height) {
        at.depth = slope == 0 ? 0 : std::clamp(height * inverse, 0.0, std::max(at.depth, 0.0));
        part.add(at);
    };
    // Along a side both heights are linear, so the cuts of a side are in order.
    for (std::uint32_t i = 0; i < count; ++i) {
        const ValueCorner& a = corners[i];
        const ValueCorner& b = corners[i + 1 == count ? 0 : i + 1];
        const double leastA = least(a);
        const double leastB = least(b);
        const double greatestA = std::max(greatest(a), leastA);
        const double greatestB = std::max(greatest(b), leastB);
        if (leastA >= 0) {
            all.add(a.at);
        }
        if (leastA < 0 && greatestA >= 0) {
            addPart(a.at, greatestA);
        }
        const bool cutsLeast = (leastA >= 0) != (leastB >= 0);
        const bool cutsGreatest = (greatestA >= 0) != (greatestB >= 0);
        const auto cutLeast = [&] {
            const Corner at = between(a.at, b.at, leastA, leastB);
            all.add(at);
            part.add(at); // at its whole depth
        };
        if (cutsLeast && leastA >= 0) {
            cutLeast();
        }
        if (cutsGreatest) {
            addPart(between(a.at, b.at, greatestA, greatestB), 0);
        }
        if (cutsLeast && leastA < 0) {
            cutLeast();
        }
    }
    return all.volume() + part.volume();
}

/// The opaque part of a volume. `from(value, sign)` is its part with that value or more: certainly where `sign` is 1,
/// possibly where it is -1. All of it has values from `lo` to `hi`.
template <class From>
ValueRange opaqueIn(const OpaqueIntervals::Some& some, double lo, double hi, double volume, const From& from) {
    const auto above = [&](double value, double sign) { return value <= lo ? volume : from(value, sign); };
    const auto beyond = [&](double value, double sign) { return value >= hi ? 0.0 : from(value, sign); };
    double certain = 0;
    for (const ValueRange& one : some.inner) {
        certain += std::max(above(one.lo, 1) - beyond(one.hi, -1), 0.0);
    }
    double possible = 0;
    for (std::size_t i = 0; i < some.outer.size(); ++i) {
        const double here = above(some.outer[i].lo, -1);
        possible = i == 0 ? here : possible - std::max(beyond(some.outer[i - 1].hi, 1) - here, 0.0);
    }
    possible -= some.outer.empty() ? 0 : beyond(some.outer.back().hi, 1);
    return {certain, std::max(possible, certain)};
}

} // namespace

void BoxMeasure::Behind::add(const Behind& other) {
    lo += other.lo;
    hi += other.hi;
    bent += other.bent;
    isRounding = isRounding && other.isRounding;
    isClear = isClear && other.isClear;
}

BoxMeasure::Behind BoxMeasure::behind(Values& values, const Sheet& sheet, double end) const {
    dvec3 lo = sheet.corners[0];
    dvec3 hi = lo;
    for (std::uint32_t i = 1; i < sheet.count; ++i) {
        lo = glm::min(lo, sheet.corners[i]);
        hi = glm::max(hi, sheet.corners[i]);
    }
    values.setBox(lo, {end, hi.y, hi.z});
    std::array<ValueCorner, Sheet::kMax> corners; // uninitialised, to save time
    double least = kInfinity;
    double greatest = -kInfinity;
    const auto setValues = [&](const dvec3& slope, double middle) {
        const dvec3 by = slope / values.half;
        const double atEnd = by.x * (end - values.centre.x);
        for (std::uint32_t i = 0; i < sheet.count; ++i) {
            const dvec3 at = sheet.corners[i] - values.centre;
            const double aside = middle + by.y * at.y + by.z * at.z;
            corners[i] = {{at.y, at.z, end - sheet.corners[i].x}, aside + by.x * at.x, aside + atEnd};
        }
    };
    setValues(values.slope, values.middle);
    for (std::uint32_t i = 0; i < sheet.count; ++i) {
        least = std::min({least, corners[i].near, corners[i].far});
        greatest = std::max({greatest, corners[i].near, corners[i].far});
    }
    least = std::max(values.lo, least - values.off - 2 * values.error);
    greatest = std::min(values.hi, greatest + values.off + 2 * values.error);
    Behind out;
    const OpaqueIntervals::Some some = part_.intervals.between(least, greatest);
    out.isClear = some.known && some.outer.empty();
    if (out.isClear) {
        return out;
    }
    const double volume = std::abs(volumeBehind(corners.data(), sheet.count));
    if (!some.known || some.outer.size() > kMaxIntervals) {
        out.hi = volume;
        out.bent = values.bent;
        out.isRounding = !some.known;
        return out;
    }
    LinearSign linear;
    double linearOf = std::nan("");
    const ValueRange found = opaqueIn(some, least, greatest, volume, [&](double value, double sign) {
        if (value != linearOf) {
            linear = linearSign(values.terms, value);
            linearOf = value;
            setValues(linear.slope, linear.middle);
            out.bent = linear.bent;
            out.isRounding = out.isRounding && linear.off <= 8 * values.error;
        }
        const double off = linear.off + 4 * values.error; // more than by the steepness where that changes by half
        return std::min(std::abs(volumeFrom(corners.data(), sheet.count, linear.slope.x / values.half.x, sign * off)),
                        volume);
    });
    out.lo = found.lo;
    out.hi = found.hi;
    return out;
}

void BoxMeasure::addBehind(Values& values, const Sheet& sheet, double end, double near, Behind& sum) {
    const Behind all = behind(values, sheet, end);
    ++parts_;
    const int axis = longestOf(all.bent);
    const double at = values.centre[axis];
    Sheet below;
    Sheet above;
    if (!all.isRounding && all.hi - all.lo > near && parts_ < lastPart_ && values.half[axis] >= kMinSide) {
        cut(sheet, axis, at, below, above);
    }
    if ((below.empty() && above.empty()) || below.jump != sheet.jump || above.jump != sheet.jump) {
        sum.add(all);
        return;
    }
    if (!above.empty()) {
        addBehind(values, above, end, near, sum);
    }
    if (!below.empty()) {
        addBehind(values, below, axis == 0 ? at : end, near, sum);
    }
    if (axis == 0 && !below.empty()) {
        below.setX(at);
        addBehind(values, below, end, near, sum);
    }
}

BoxVolume BoxMeasure::behindSheets(const CellPartBox& box, Values& values, const SheetList& sheets, Jump base,
                                   double near, const BoxVolume* whole) {
    const Share all = shareOf(box, sheets, base);
    Behind sum;
    sum.isRounding = all.unknown == 0;
    sum.isClear = all.unknown == 0;
    if (base == 1) {
        const BoxVolume front = whole != nullptr ? *whole : opaque(box);
        sum.add({front.lo, front.hi, {}, front.gain == 0, false});
        sum.bent[front.axis] = front.gain;
    }
    lastPart_ = parts_ + kMaxParts * (sheets.count() + 1);
    Sheet sheet;
    for (std::size_t i = 0; i < sheets.count(); ++i) {
        sheets.get(i, sheet);
        if (sheet.jump == 0 || sheet.jump == kUnknownJump) {
            continue;
        }
        Behind one;
        addBehind(values, sheet, box.hi.x, near, one);
        one.bent *= one.hi - one.lo;
        if ((sheet.jump > 0) != (sheet.area() > 0)) {
            one.lo = -std::exchange(one.hi, -one.lo);
        }
        sum.add(one);
    }
    const double slack = 2 * all.slack + all.unknown;
    BoxVolume out;
    out.mayOverlap = !sum.isClear;
    out.hi = sum.isClear ? 0 : std::clamp(std::min(sum.hi, all.volume) + slack, 0.0, box.volume());
    out.lo = std::clamp(sum.lo - slack, 0.0, out.hi);
    const dvec3 side = box.hi - box.lo;
    out.axis = longestOf(all.unknown > 0 ? side : sum.bent);
    if (side[out.axis] < kMinSide) {
        out.axis = longestOf(side);
    }
    const bool isDone = sum.isRounding || side[out.axis] < kMinSide || out.hi - out.lo <= 8 * all.slack;
    out.gain = isDone ? 0 : out.hi - out.lo;
    return out;
}

/// Measures a box with one end of an opaque interval in its range of values, on either side of a surface.
std::optional<BoxVolume> BoxMeasure::behindGraph(const CellPartBox& box, const Values& values) const {
    const OpaqueIntervals::Some some = part_.intervals.between(values.lo, values.hi);
    if (!some.known || some.outer.size() != 1 || some.inner.size() != 1) {
        return {};
    }
    const ValueRange& outer = some.outer.front();
    const ValueRange& inner = some.inner.front();
    const bool isAbove = outer.hi >= values.hi && inner.hi >= values.hi;
    if (isAbove == (outer.lo <= values.lo && inner.lo <= values.lo)) {
        return {};
    }
    const double from = isAbove ? inner.lo : inner.hi;
    const std::optional<GraphShare> graph = graphShare(values.terms, from);
    if (!graph) {
        return {};
    }
    const double apart = isAbove ? inner.lo - outer.lo : outer.hi - inner.hi;
    const double rounding = (4 * values.error + apart) / graph->steepness + 0x1p-40;
    const double error = graph->error + rounding;
    const double share = isAbove ? graph->share : 1 - graph->share;
    BoxVolume out;
    out.lo = std::clamp(share - error, 0.0, 1.0) * box.volume();
    out.hi = std::clamp(share + error, 0.0, 1.0) * box.volume();
    out.axis = graph->axis;
    const bool isRounding = graph->error <= 4 * rounding || (box.hi - box.lo)[out.axis] < kMinSide;
    out.gain = isRounding ? 0 : out.hi - out.lo;
    return out;
}

/// By the part above a value of a linear function.
BoxVolume BoxMeasure::linearly(const CellPartBox& box, Values values) const {
    const OpaqueIntervals::Some some = part_.intervals.between(values.lo, values.hi);
    const dvec3 side = box.hi - box.lo;
    BoxVolume out;
    out.hi = box.volume();
    out.axis = longestOf(side);
    const bool isSmall = side[out.axis] < kMinSide;
    if (!some.known || some.outer.size() > kMaxIntervals) {
        out.gain = isSmall || !some.known ? 0 : out.hi;
        return out;
    }
    const double flat = kFlatSlope * (std::abs(values.slope.x) + std::abs(values.slope.y) + std::abs(values.slope.z));
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(values.slope[axis]) < flat) {
            values.off += std::abs(values.slope[axis]);
            values.slope[axis] = 0;
        }
    }
    const ValueRange found = opaqueIn(some, values.lo, values.hi, out.hi, [&](double value, double sign) {
        return box.volume() * linearShare(values.slope, value + sign * values.off - values.middle);
    });
    const double slack = (kShareError + values.thickness()) * box.volume() * static_cast<double>(2 * some.outer.size());
    out.lo = std::clamp(found.lo - slack, 0.0, out.hi);
    out.hi = std::clamp(found.hi + slack, out.lo, out.hi);
    const bool isRounding = values.off <= 8 * values.error;
    out.gain = isSmall || isRounding || out.hi - out.lo <= 4 * slack ? 0 : out.hi - out.lo;
    out.axis = longestOf(values.bent);
    if (side[out.axis] < kMinSide) {
        out.axis = longestOf(side);
    }
    return out;
}

BoxVolume BoxMeasure::opaque(const CellPartBox& box) const {
    const Values values = valuesOn(box);
    BoxVolume out;
    if (part_.intervals.contain(values.lo, values.hi)) {
        out.lo = out.hi = box.volume();
        return out;
    }
    if (!part_.intervals.mayMeet(values.lo, values.hi)) {
        out.mayOverlap = false;
        return out;
    }
    const std::optional<BoxVolume> graph = behindGraph(box, values);
    return graph ? *graph : linearly(box, values);
}

BoxVolume BoxMeasure::measure(const CellPartBox& box, const SheetList& sheets, Jump base, double near,
                              const BoxVolume* whole) {
    BoxVolume out;
    if (sheets.count() == 0 && base == 1) {
        out = opaque(box);
        out.mayLeave = false;
        return out;
    }
    Values values = valuesOn(box);
    const bool isAll = part_.intervals.contain(values.lo, values.hi);
    const bool mayBe = part_.intervals.mayMeet(values.lo, values.hi);
    if (!mayBe || (sheets.count() == 0 && base == 0)) {
        out.mayOverlap = false;
        out.mayLeave = mayBe;
        out.outside = isAll ? box.volume() : 0;
        return out;
    }
    if (!isAll) {
        out = behindSheets(box, values, sheets, base, near, whole);
        out.outside = wantsOutside_ ? std::max(opaque(box).lo - out.hi, 0.0) : 0;
        return out;
    }
    const Share all = shareOf(box, sheets, base);
    out.hi = std::clamp(all.volume + all.unknown + all.slack, 0.0, box.volume());
    out.lo = std::clamp(all.volume - all.unknown - all.slack, 0.0, out.hi);
    out.axis = longestOf(box.hi - box.lo);
    out.gain = all.unknown > 0 && (box.hi - box.lo)[out.axis] >= kMinSide ? out.hi - out.lo : 0;
    out.outside = box.volume() - out.hi;
    return out;
}

} // namespace voxtact::cpu
