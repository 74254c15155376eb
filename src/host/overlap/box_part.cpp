// SPDX-License-Identifier: MIT
#include "host/overlap/box_part.h"
#include "core/base/infinity.h"
#include "host/overlap/cube_share.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

/// A function that has more opaque intervals in the range of a box is left for smaller boxes.
constexpr std::size_t kMaxIntervals = 8;
/// A box with a shorter side is not divided again, voxels.
constexpr double kMinSide = 0x1p-24;
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
    double lo = 0;
    double hi = 0;
    double error = 0;
    double middle = 0; ///< of the linear function
    dvec3 slope{};     ///< a half side along each axis changes it by so much
    double off = 0;    ///< all of `error` included
    dvec3 bent{};      ///< part of it that a division across an axis removes
    dvec3 centre{};
    dvec3 half{};
    Trilinear terms{}; ///< of the box

    [[nodiscard]] double at(const dvec3& place) const noexcept {
        const dvec3 own = (place - centre) / half;
        return own.x * slope.x + own.y * slope.y + own.z * slope.z;
    }
    /// No linear value is farther from the middle one, at corners that are off by a box or so.
    [[nodiscard]] double size() const noexcept {
        return 4 * (std::abs(slope.x) + std::abs(slope.y) + std::abs(slope.z));
    }
    /// Part of the box between two values, at most `error` apart.
    [[nodiscard]] double thickness() const noexcept {
        const double steepest = std::max({std::abs(slope.x), std::abs(slope.y), std::abs(slope.z)});
        return steepest > 0 ? std::min(1.0, 4 * error / steepest) : 1.0;
    }
};

/// The space behind sheets.
struct BoxMeasure::Share {
    double volume = 0;  ///< voxels
    double unknown = 0; ///< of sheets whose jump is unknown
    double slack = 0;   ///< rounding of either
    bool isCrossed = false;
    bool isInside = false; ///< all of the box; if it is not crossed
};

BoxMeasure::Values BoxMeasure::valuesOn(const CellPartBox& box) const {
    const PartCell cell = part_.cell(volume_, box.cell);
    Values out;
    out.centre = 0.5 * (box.lo + box.hi);
    out.half = 0.5 * (box.hi - box.lo);
    const dvec3 cellMiddle{box.cell[0] + 0.5, box.cell[1] + 0.5, box.cell[2] + 0.5};
    const Trilinear terms = within(cell.terms, 2.0 * (out.centre - cellMiddle), 2.0 * out.half);
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
    const auto [lo, hi] = std::ranges::minmax(values);
    out.error = 4 * cell.error;
    out.lo = lo - out.error;
    out.hi = hi + out.error;
    double all = 0; // NaN where a value is
    for (const double value : values) {
        all += value;
    }
    if (!std::isfinite(all)) {
        out.lo = out.hi = std::nan("");
    }
    out.terms = terms;
    out.middle = terms[0];
    out.slope = {terms[1], terms[2], terms[4]};
    const double cubic = std::abs(terms[7]);
    out.bent = {std::abs(terms[3]) + std::abs(terms[5]) + cubic, std::abs(terms[3]) + std::abs(terms[6]) + cubic,
                std::abs(terms[5]) + std::abs(terms[6]) + cubic};
    out.off = std::abs(terms[3]) + std::abs(terms[5]) + std::abs(terms[6]) + cubic + 2 * out.error;
    return out;
}

void BoxMeasure::placeSheets(const CellPartBox& box, const Values* values, const SheetList& sheets, Jump base,
                             Share& all) {
    corners_.clear();
    placed_.clear();
    const auto place = [&](const dvec3* corners, std::uint32_t count, double jump) {
        Placed& placed = placed_.emplace_back();
        placed.first = static_cast<std::uint32_t>(corners_.size());
        placed.count = count;
        placed.jump = jump;
        for (std::uint32_t i = 0; i < count; ++i) {
            const dvec3& at = corners[i];
            Corner corner{at.y - box.lo.y, at.z - box.lo.z, box.hi.x - at.x};
            if (values != nullptr) {
                corner.near = values->at(at);
                corner.far = values->at({box.hi.x, at.y, at.z});
                placed.least = std::min({placed.least, corner.near, corner.far});
                placed.greatest = std::max({placed.greatest, corner.near, corner.far});
            }
            corners_.push_back(corner);
        }
        const double volume = volumeBehind(&corners_[placed.first], count);
        placed.volume = volume;
        if (std::abs(jump) > 1) {
            all.unknown += std::abs(volume);
        } else {
            all.volume += jump * volume;
        }
    };
    // Starts with the whole front face: the space behind it is the box.
    const std::array<dvec3, 4> front{box.lo, dvec3{box.lo.x, box.hi.y, box.lo.z}, dvec3{box.lo.x, box.hi.y, box.hi.z},
                                     dvec3{box.lo.x, box.lo.y, box.hi.z}};
    place(front.data(), 4, base);
    Sheet sheet;
    for (std::size_t i = 0; i < sheets.count(); ++i) {
        sheets.get(i, sheet);
        place(sheet.corners.data(), sheet.count, sheet.jump);
    }
    const dvec3 side = box.hi - box.lo;
    all.slack =
        kFaces * rounding_ * (side.y * side.z + side.x * (side.y + side.z)) * static_cast<double>(placed_.size());
    all.isCrossed = sheets.count() > 0 || base == kUnknownJump;
    all.isInside = base == 1;
}

double BoxMeasure::volumeBehind(const Corner* corners, std::uint32_t count) noexcept {
    double sum = 0;
    for (std::uint32_t i = 2; i < count; ++i) {
        const Corner& a = corners[0];
        const Corner& b = corners[i - 1];
        const Corner& c = corners[i];
        sum += ((b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y)) * (a.way + b.way + c.way);
    }
    return sum / 6;
}

/// If the values grow along the path (slope > 0), the whole path counts if it begins at `from` or above, else the part
/// beyond `from`; and vice versa.
double BoxMeasure::volumeFrom(const Corner* corners, std::uint32_t count, double slope, double from) noexcept {
    const double inverse = 1 / std::abs(slope);
    std::array<Corner, 2 * Sheet::kMax + 2> all;
    std::array<Corner, 2 * Sheet::kMax + 2> part;
    std::uint32_t allCount = 0;
    std::uint32_t partCount = 0;
    const auto least = [&](const Corner& at) { return (slope > 0 ? at.near : at.far) - from; };
    const auto greatest = [&](const Corner& at) { return (slope > 0 ? at.far : at.near) - from; };
    const auto between = [](const Corner& a, const Corner& b, double heightA, double heightB) {
        const double t = heightA / (heightA - heightB);
        return Corner{a.y + t * (b.y - a.y), a.z + t * (b.z - a.z), a.way + t * (b.way - a.way),
                      a.near + t * (b.near - a.near), a.far + t * (b.far - a.far)};
    };
    const auto addPart = [&](Corner at, double height) {
        at.way = slope == 0 ? 0 : std::clamp(height * inverse, 0.0, std::max(at.way, 0.0));
        part[partCount++] = at;
    };
    // Along a side both heights are linear, so the cuts of a side are in order.
    for (std::uint32_t i = 0; i < count; ++i) {
        const Corner& a = corners[i];
        const Corner& b = corners[i + 1 == count ? 0 : i + 1];
        const double leastA = least(a);
        const double leastB = least(b);
        const double greatestA = std::max(greatest(a), leastA);
        const double greatestB = std::max(greatest(b), leastB);
        if (leastA >= 0) {
            all[allCount++] = a;
        }
        if (leastA < 0 && greatestA >= 0) {
            addPart(a, greatestA);
        }
        const bool cutsLeast = (leastA >= 0) != (leastB >= 0);
        const bool cutsGreatest = (greatestA >= 0) != (greatestB >= 0);
        const auto cutLeast = [&] {
            const Corner at = between(a, b, leastA, leastB);
            all[allCount++] = at;
            part[partCount++] = at; // with all of the way
        };
        if (cutsLeast && leastA >= 0) {
            cutLeast();
        }
        if (cutsGreatest) {
            addPart(between(a, b, greatestA, greatestB), 0);
        }
        if (cutsLeast && leastA < 0) {
            cutLeast();
        }
    }
    return (allCount > 2 ? volumeBehind(all.data(), allCount) : 0) +
           (partCount > 2 ? volumeBehind(part.data(), partCount) : 0);
}

/// Behind all sheets whose jump is known.
double BoxMeasure::behind(const Values& values, double from) const {
    const double least = from - values.middle;
    double sum = 0;
    for (const Placed& one : placed_) {
        if (one.jump == 0 || one.jump > 1 || one.greatest < least) {
            continue;
        }
        sum += one.jump * (one.least >= least
                               ? one.volume
                               : volumeFrom(&corners_[one.first], one.count, values.slope.x / values.half.x, least));
    }
    return sum;
}

template <class Behind>
BoxVolume BoxMeasure::between(const CellPartBox& box, const Values& values, const Share& all,
                              const Behind& behind) const {
    const OpaqueIntervals::Some some = part_.intervals.between(values.lo, values.hi);
    BoxVolume out;
    out.hi = std::min(std::max(all.volume, 0.0) + all.unknown + all.slack, box.volume());
    const dvec3 side = box.hi - box.lo;
    out.axis = longestOf(side);
    const bool isSmall = side[out.axis] < kMinSide;
    if (!some.known || some.outer.size() > kMaxIntervals) {
        out.gain = isSmall || !some.known ? 0 : out.hi;
        return out;
    }
    const auto from = [&](double value) {
        return value > values.hi ? 0.0 : (value < values.lo ? all.volume : behind(value));
    };
    double certain = 0;
    for (const ValueRange& one : some.inner) {
        const double lo = one.lo <= values.lo ? -kInfinity : one.lo + values.off;
        const double hi = one.hi >= values.hi ? kInfinity : one.hi - values.off;
        certain += lo < hi ? std::max(from(lo) - from(hi), 0.0) : 0;
    }
    double possible = 0;
    double begin = kInfinity; // intervals that are so near to each other are one
    double end = -kInfinity;
    const auto addPossible = [&] { possible += begin < end ? std::max(from(begin) - from(end), 0.0) : 0; };
    for (const ValueRange& one : some.outer) {
        const double lo = one.lo <= values.lo ? -kInfinity : one.lo - values.off;
        if (lo > end) {
            addPossible();
            begin = lo;
        }
        begin = std::min(begin, lo);
        end = one.hi >= values.hi ? kInfinity : one.hi + values.off;
    }
    addPossible();
    const double slack = all.slack * static_cast<double>(2 * some.outer.size());
    out.lo = std::clamp(certain - slack - all.unknown, 0.0, out.hi);
    out.hi = std::clamp(possible + slack + all.unknown, out.lo, out.hi);
    const bool isRounding = values.off <= 8 * values.error && all.unknown == 0;
    out.gain = isSmall || isRounding || out.hi - out.lo <= 4 * slack ? 0 : out.hi - out.lo;
    out.axis = all.unknown > 0 ? out.axis : longestOf(values.bent);
    if (side[out.axis] < kMinSide) {
        out.axis = longestOf(side);
    }
    return out;
}

/// Every point of the solid is behind some sheet.
bool BoxMeasure::mayBeOpaqueBehind(const Values& values) const {
    double least = kInfinity;
    double greatest = -kInfinity;
    for (const Placed& one : placed_) {
        least = one.jump != 0 ? std::min(least, one.least) : least;
        greatest = one.jump != 0 ? std::max(greatest, one.greatest) : greatest;
    }
    const double beside = values.off + 2 * values.error + 0x1p-40 * values.size();
    return part_.intervals.mayMeet(std::max(values.middle + least - beside, values.lo),
                                   std::min(values.middle + greatest + beside, values.hi));
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

BoxVolume BoxMeasure::opaque(const CellPartBox& box) {
    Values values = valuesOn(box);
    BoxVolume out;
    if (part_.intervals.contain(values.lo, values.hi)) {
        out.lo = out.hi = box.volume();
        return out;
    }
    if (!part_.intervals.mayMeet(values.lo, values.hi)) {
        out.mayOverlap = false;
        return out;
    }
    if (const std::optional<BoxVolume> graph = behindGraph(box, values)) {
        return *graph;
    }
    const double flat = kFlatSlope * (std::abs(values.slope.x) + std::abs(values.slope.y) + std::abs(values.slope.z));
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(values.slope[axis]) < flat) {
            values.off += std::abs(values.slope[axis]);
            values.slope[axis] = 0;
        }
    }
    Share all;
    all.volume = box.volume();
    all.slack = (kShareError + values.thickness()) * box.volume();
    all.isInside = true;
    return between(box, values, all,
                   [&](double from) { return all.volume * linearShare(values.slope, from - values.middle); });
}

BoxVolume BoxMeasure::measure(const CellPartBox& box, const SheetList& sheets, Jump base) {
    if (sheets.count() == 0 && base == 1) {
        BoxVolume out = opaque(box);
        out.mayLeave = false;
        return out;
    }
    const bool isEmpty = sheets.count() == 0 && base == 0;
    const Values values = valuesOn(box);
    if (isEmpty || !part_.intervals.mayMeet(values.lo, values.hi)) {
        BoxVolume none;
        none.mayOverlap = false;
        none.mayLeave = part_.intervals.mayMeet(values.lo, values.hi);
        none.outside = part_.intervals.contain(values.lo, values.hi) ? box.volume() : 0;
        return none;
    }
    Share all;
    const bool isAll = part_.intervals.contain(values.lo, values.hi);
    placeSheets(box, isAll ? nullptr : &values, sheets, base, all);
    if (!isAll && !mayBeOpaqueBehind(values)) {
        BoxVolume none;
        none.mayOverlap = false;
        none.outside = opaque(box).lo;
        return none;
    }
    if (!isAll) {
        all.slack += values.thickness() * box.volume() * static_cast<double>(placed_.size());
        BoxVolume out = between(box, values, all, [&](double from) { return behind(values, from); });
        out.mayLeave = all.isCrossed;
        out.outside = std::max(opaque(box).lo - out.hi, 0.0);
        return out;
    }
    BoxVolume out;
    out.hi = std::clamp(all.volume + all.unknown + all.slack, 0.0, box.volume());
    out.lo = std::clamp(all.volume - all.unknown - all.slack, 0.0, out.hi);
    out.axis = longestOf(box.hi - box.lo);
    out.gain = all.unknown > 0 && (box.hi - box.lo)[out.axis] >= kMinSide ? out.hi - out.lo : 0;
    out.outside = box.volume() - out.hi;
    out.mayLeave = all.isCrossed;
    return out;
}

} // namespace voxtact::cpu
