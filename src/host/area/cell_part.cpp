// SPDX-License-Identifier: MIT
#include "host/area/cell_part.h"
#include "core/base/infinity.h"
#include "host/scene/stored_voxels.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

/// Maximum ratio of the whole volume's range to the sum of the cell's terms for which the range replaces that of the
/// cell's surroundings.
constexpr double kFewTimes = 16;
/// A part whose box has become so small in its cell (half sides) is not divided again.
constexpr double kLeastHalf = 0x1p-26;
/// A function that has more opaque intervals in the range of a part is examined when the part is smaller.
constexpr std::size_t kMostIntervals = 8;

/// Returns the smallest and largest stored value at the corners of a cell and its neighbours.
ValueRange rangeAround(const StoredImage& image, const NodePlace& padded) {
    ValueRange range{kInfinity, -kInfinity};
    image.visit([&](const auto* voxels) {
        std::array<std::int64_t, 3> first{};
        std::array<std::int64_t, 3> end{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = std::max(padded[axis] - 1, 0);
            end[axis] = std::min(padded[axis] + 3, image.size[axis] + 2);
        }
        for (std::int64_t z = first[2]; z < end[2]; ++z) {
            for (std::int64_t y = first[1]; y < end[1]; ++y) {
                for (std::int64_t x = first[0]; x < end[0]; ++x) {
                    const auto* at = voxels + x + y * image.stride[1] + z * image.stride[2];
                    const auto stored = static_cast<double>(storedValue(*at));
                    range = {std::min(range.lo, stored), std::max(range.hi, stored)};
                }
            }
        }
    });
    return range;
}

int largest(const dvec3& of) {
    return of.x >= of.y && of.x >= of.z ? 0 : (of.y >= of.z ? 1 : 2);
}

/// The interpolant on a part: at each corner the linear approximation, its error, and its range.
struct PartValues {
    Heights linear{};
    double off = 0;
    double lo = kInfinity;
    double hi = -kInfinity;
    dvec3 bent{}; ///< contribution of the part's box sides along each axis to `off`
    dvec3 half{}; ///< half of these, in the cell's coordinates
};

/// Returns the maximum deviation of the interpolant of a cell from its middle value.
double spreadOf(const Trilinear& terms) {
    double sum = 0;
    for (std::size_t i = 1; i < terms.size(); ++i) {
        sum += std::abs(terms[i]);
    }
    return sum;
}

/// The quadratic terms at a mean of corners are the weighted mean of the terms of all pairs of corners, so they lie
/// between the smallest and the largest of these.
ValueRange quadraticRange(const Trilinear& terms, std::span<const dvec3> corners) {
    ValueRange range{kInfinity, -kInfinity};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const dvec3& a = corners[i];
        const dvec3 along{terms[3] * a.y + terms[5] * a.z, terms[3] * a.x + terms[6] * a.z,
                          terms[5] * a.x + terms[6] * a.y};
        for (std::size_t j = i; j < corners.size(); ++j) {
            const double both = 0.5 * dot(along, corners[j]);
            range = {std::min(range.lo, both), std::max(range.hi, both)};
        }
    }
    return range;
}

PartValues valuesOn(const AreaFrame& frame, const UvPolygon& polygon, const PartCell& cell, double error) {
    std::array<dvec3, UvPolygon::kMost> places{};
    dvec3 lo(kInfinity);
    dvec3 hi(-kInfinity);
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        places[i] = 2.0 * (frame.at(polygon.corners[i]) - cell.middle);
        lo = glm::min(lo, places[i]);
        hi = glm::max(hi, places[i]);
    }
    PartValues out;
    const dvec3 middle = 0.5 * (lo + hi);
    out.half = 0.5 * (hi - lo);
    const Trilinear terms = within(cell.terms, middle, out.half);
    const dvec3 inverse = 1.0 / glm::max(out.half, dvec3(1e-300));
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        places[i] = glm::clamp((places[i] - middle) * inverse, dvec3(-1), dvec3(1));
    }
    const ValueRange bent = quadraticRange(terms, std::span(places).first(polygon.count));
    const double cubic = std::abs(terms[7]);
    out.off = 0.5 * (bent.hi - bent.lo) + cubic + 2 * error;
    out.bent = {std::abs(terms[3]) + std::abs(terms[5]) + cubic, std::abs(terms[3]) + std::abs(terms[6]) + cubic,
                std::abs(terms[5]) + std::abs(terms[6]) + cubic};
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        const dvec3& at = places[i];
        out.linear[i] = terms[0] + 0.5 * (bent.lo + bent.hi) + at.x * terms[1] + at.y * terms[2] + at.z * terms[4];
        out.lo = std::min(out.lo, out.linear[i] - out.off);
        out.hi = std::max(out.hi, out.linear[i] + out.off);
    }
    return out;
}

/// The area of a part where the linear values are opaque: those that certainly are, and those that may be.
struct Share {
    double certain = 0;
    double possible = 0;
};

Share opaqueShare(const UvPolygon& polygon, const PartValues& values, const OpaqueIntervals::Some& some) {
    Share share;
    double from = -kInfinity; // possible intervals, merged where they overlap
    double to = -kInfinity;
    for (const ValueRange& one : some.inner) {
        share.certain += areaBetween(polygon, values.linear, one.lo + values.off, one.hi - values.off);
    }
    for (const ValueRange& one : some.outer) {
        if (one.lo - values.off > to) {
            share.possible += areaBetween(polygon, values.linear, from, to);
            from = one.lo - values.off;
        }
        to = one.hi + values.off;
    }
    share.possible += areaBetween(polygon, values.linear, from, to);
    return share;
}

} // namespace

PartMeasure::PartMeasure(const VolumeImpl& volume, const OpaquePart& part, const AreaSlack& slack)
    : volume_(volume), part_(part), reach_(slack.reach()) {
    const ValueRange& all = part.storedRange;
    wide_ = (all.hi - all.lo) * reach_;
    wideError_ = wide_ + valueError(all.lo, all.hi);
}

PartArea PartMeasure::whole(const AreaFrame& frame, const UvPolygon& polygon) noexcept {
    const double area = polygon.area();
    const double error = polygon.areaError();
    return {std::max(area - error, 0.0) * frame.lo, (area + error) * frame.hi};
}

bool PartMeasure::allOpaque(const NodePlace& brick) const {
    const std::size_t number = part_.occupancy.brickNumber(brick);
    return part_.occupancy.mayBeOpaque(number) &&
           part_.intervals.contain(static_cast<double>(volume_.bricks.lo[number]) - wideError_,
                                   static_cast<double>(volume_.bricks.hi[number]) + wideError_);
}

double PartMeasure::errorAround(const NodePlace& padded, const PartCell& cell) const {
    double local = 0;
    for (std::size_t term = 1; term < cell.terms.size(); ++term) {
        local += std::abs(cell.terms[term]);
    }
    if (part_.storedRange.hi - part_.storedRange.lo <= kFewTimes * local) {
        return wide_;
    }
    const ValueRange range = rangeAround(volume_.image, padded);
    return (range.hi - range.lo) * reach_;
}

/// Returns the area in a cell whose voxels are all equal. Rounding moves no value there, but a part may be in another
/// cell.
PartArea PartMeasure::areaInside(const AreaFrame& frame, const CellPart& part, const PartCell& cell) const {
    PartArea out = whole(frame, part.polygon);
    const ValueRange around = rangeAround(volume_.image, part.padded);
    if (around.lo < around.hi) {
        const double all = part.polygon.area();
        double inside = all - 7 * part.polygon.areaError();
        for (int axis = 0; axis < 3; ++axis) {
            const Heights heights = heightsAlong(frame, part.polygon, axis, cell.middle[axis]);
            inside -= std::max(all - areaBetween(part.polygon, heights, reach_ - 0.5, 0.5 - reach_), 0.0);
        }
        out.lo = std::max(inside, 0.0) * frame.lo;
    }
    out.lo = part.atEdge ? 0 : out.lo;
    return out;
}

PartArea PartMeasure::area(const AreaFrame& frame, const CellPart& part) const {
    PartArea out = whole(frame, part.polygon);
    const PartCell cell = part_.cell(volume_, part.padded);
    if (cell.error == 0 && part_.intervals.contain(cell.terms[0], cell.terms[0])) {
        return areaInside(frame, part, cell);
    }
    const double error = cell.error + errorAround(part.padded, cell);
    if (part_.intervals.contain(cell.terms[0] - spreadOf(cell.terms) - error,
                                cell.terms[0] + spreadOf(cell.terms) + error)) {
        out.lo = part.atEdge ? 0 : out.lo; // as in most cells deep inside the opaque region
        return out;
    }
    const PartValues values = valuesOn(frame, part.polygon, cell, error);
    if (part_.intervals.contain(values.lo, values.hi)) {
        out.lo = part.atEdge ? 0 : out.lo; // dividing it tells no more
        return out;
    }
    const OpaqueIntervals::Some some = part_.intervals.between(values.lo, values.hi);
    if (some.known && some.outer.empty()) {
        return {};
    }
    const bool small = values.half[largest(values.half)] < kLeastHalf;
    if (!some.known || some.outer.size() > kMostIntervals) {
        out.lo = 0;
        out.gain = small || !some.known ? 0 : out.hi;
        out.axis = largest(values.half);
        return out;
    }
    const Share share = opaqueShare(part.polygon, values, some);
    const double doubt = part.polygon.areaError() * static_cast<double>(2 * some.outer.size() + 1);
    const double certain = std::max(share.certain - doubt, 0.0) * frame.lo;
    out.lo = part.atEdge ? 0 : certain;
    out.hi = std::min((share.possible + doubt) * frame.hi, out.hi);
    // Division does not decide a part that rounding leaves open.
    out.gain = small || !(values.off > 4 * error) ? 0 : std::max(out.hi - certain, 0.0);
    out.axis = largest(values.bent);
    return out;
}

} // namespace voxtact::cpu
