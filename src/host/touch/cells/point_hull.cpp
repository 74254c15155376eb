// SPDX-License-Identifier: MIT
#include "host/touch/cells/point_hull.h"
#include "core/base/infinity.h"

#include <cmath>

namespace voxtact::cpu {

namespace {

using shader::VoxelPoint;

struct Range {
    double lo = 0;
    double hi = 0;

    [[nodiscard]] double middle() const noexcept { return 0.5 * (lo + hi); }
    [[nodiscard]] double half() const noexcept { return 0.5 * (hi - lo); }
};

double lerp(double a, double b, double weight) noexcept {
    return a + weight * (b - a);
}

/// The interpolant of a cell around a point: its linear part, and the maximum of the rest in a box around that point.
struct Linear {
    double value = 0;
    double x = 0;
    double y = 0;
    double z = 0;
    double rest = 0;
};

Linear linearIn(const shader::CertifiedCell& cell, const Range& x, const Range& y, const Range& z) noexcept {
    const double mx = x.middle();
    const double my = y.middle();
    const double mz = z.middle();
    // Along x first: values and differences at the four edges.
    const double v00 = lerp(cell.x000, cell.x100, mx);
    const double v10 = lerp(cell.x010, cell.x110, mx);
    const double v01 = lerp(cell.x001, cell.x101, mx);
    const double v11 = lerp(cell.x011, cell.x111, mx);
    const double d00 = double{cell.x100} - cell.x000;
    const double d10 = double{cell.x110} - cell.x010;
    const double d01 = double{cell.x101} - cell.x001;
    const double d11 = double{cell.x111} - cell.x011;
    const double xy = lerp(d10 - d00, d11 - d01, mz);
    const double xz = lerp(d01 - d00, d11 - d10, my);
    const double yz = (v11 - v01) - (v10 - v00);
    const double xyz = (d11 - d01) - (d10 - d00);
    Linear out;
    out.value = lerp(lerp(v00, v10, my), lerp(v01, v11, my), mz);
    out.x = lerp(lerp(d00, d10, my), lerp(d01, d11, my), mz);
    out.y = lerp(v10 - v00, v11 - v01, mz);
    out.z = lerp(v01 - v00, v11 - v10, my);
    out.rest = std::abs(xy) * x.half() * y.half() + std::abs(xz) * x.half() * z.half() +
               std::abs(yz) * y.half() * z.half() + std::abs(xyz) * x.half() * y.half() * z.half();
    return out;
}

/// Part of a hull's box in a cell, relative to the cell's corner.
struct Part {
    VoxelPoint lo{};
    VoxelPoint hi{};
};

Part partOf(const PointHull& hull, const VoxelPoint& origin, const shader::CertifiedCell& cell) noexcept {
    const VoxelPoint lo = shader::voxelDifference(hull.lo, origin);
    const VoxelPoint hi = shader::voxelDifference(hull.hi, origin);
    Part part;
    shader::certifiedPart(lo.x, hi.x, hi.x, hull.delta, cell.lo.x, cell.hi.x, part.lo.x, part.hi.x);
    shader::certifiedPart(lo.y, hi.y, hi.y, hull.delta, cell.lo.y, cell.hi.y, part.lo.y, part.hi.y);
    shader::certifiedPart(lo.z, hi.z, hi.z, hull.delta, cell.lo.z, cell.hi.z, part.lo.z, part.hi.z);
    return part;
}

/// Minimum and maximum dot product of a point with (x, y, z).
Range along(const PointHull& hull, double x, double y, double z) noexcept {
    // Several chains of comparisons, without dependencies between them. All skip NaN.
    constexpr std::size_t kChains = 4;
    std::array<Range, kChains> ranges;
    ranges.fill({kInfinity, -kInfinity});
    const auto take = [&](Range& range, std::size_t i) {
        const double at = x * hull.x[i] + y * hull.y[i] + z * hull.z[i];
        range.lo = std::min(range.lo, at);
        range.hi = std::max(range.hi, at);
    };
    std::size_t i = 0;
    for (; i + kChains <= hull.count; i += kChains) {
        for (std::size_t chain = 0; chain < kChains; ++chain) {
            take(ranges[chain], i + chain);
        }
    }
    for (; i < hull.count; ++i) {
        take(ranges[i % kChains], i);
    }
    Range whole = ranges[0];
    for (const Range& range : ranges) {
        whole.lo = std::min(whole.lo, range.lo);
        whole.hi = std::max(whole.hi, range.hi);
    }
    return whole;
}

/// In units of a cell's pointError: one for the interpolation here, one for certifiedPartMayBeOpaque(), one for its
/// test.
constexpr float kErrors = 3;

VoxelPoint originOf(std::int32_t x, std::int32_t y, std::int32_t z) noexcept {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

bool partMayMeetLinearly(const shader::OpaqueValues& opaque, const PointHull& hull, const shader::CertifiedCell& cell,
                         const VoxelPoint& origin, const Part& part) noexcept {
    const Range partX{part.lo.x, part.hi.x};
    const Range partY{part.lo.y, part.hi.y};
    const Range partZ{part.lo.z, part.hi.z};
    const Linear linear = linearIn(cell, partX, partY, partZ);
    // A linear function is nowhere in the hull beyond its values at the points.
    const Range dots = along(hull, linear.x, linear.y, linear.z);
    const double from = linear.value - linear.x * (origin.x + partX.middle()) - linear.y * (origin.y + partY.middle()) -
                        linear.z * (origin.z + partZ.middle());
    const double displaced = 2.0 * hull.delta * (std::abs(linear.x) + std::abs(linear.y) + std::abs(linear.z));
    const double least = std::max(from + dots.lo - displaced - linear.rest, double{cell.least});
    const double greatest = std::min(from + dots.hi + displaced + linear.rest, double{cell.greatest});
    if (!(least <= greatest)) {
        return true; // NaN, or the hull is outside the cell: other tests decide
    }
    // The part of the range that is added is far more than what certifiedDecide() leaves open at its resolution.
    constexpr float kPart = 1.0F / 64;
    const float slack = kErrors * cell.pointError + kPart * (cell.greatest - cell.least);
    return shader::certifiedMayBeOpaque(opaque, static_cast<float>(least), static_cast<float>(greatest), slack);
}

} // namespace

void RunPoints::add(const shader::CertifiedVertex& vertex, std::uint32_t triangle) noexcept {
    const VoxelPoint& at = vertex.point;
    const bool isFirst = count_ == 0;
    x_[count_] = at.x;
    y_[count_] = at.y;
    z_[count_] = at.z;
    triangles_[count_] = triangle;
    ++count_;
    lo_ = isFirst ? at : VoxelPoint{std::min(lo_.x, at.x), std::min(lo_.y, at.y), std::min(lo_.z, at.z)};
    hi_ = isFirst ? at : VoxelPoint{std::max(hi_.x, at.x), std::max(hi_.y, at.y), std::max(hi_.z, at.z)};
    // A number that is not finite stays.
    const bool isFarther = error_ <= CERTIFIED_FARTHEST && !(vertex.error <= error_);
    error_ = isFirst || isFarther ? vertex.error : error_;
}

shader::CertifiedBounds RunPoints::bounds(const shader::CertifiedItem& item) const noexcept {
    return shader::certifiedBounds(item, {lo_, error_}, {hi_, error_}, {hi_, error_});
}

bool hullMayMeet(const shader::OpaqueValues& opaque, const PointHull& hull, const shader::CertifiedCell& cell,
                 std::int32_t x, std::int32_t y, std::int32_t z) noexcept {
    const VoxelPoint origin = originOf(x, y, z);
    const Part part = partOf(hull, origin, cell);
    float least = 0;
    float greatest = 0;
    shader::certifiedBoxRange(cell, part.lo, part.hi, least, greatest);
    return shader::certifiedMayBeOpaque(opaque, least, greatest, kErrors * cell.pointError) &&
           partMayMeetLinearly(opaque, hull, cell, origin, part);
}

bool hullMayMeetLinearly(const shader::OpaqueValues& opaque, const PointHull& hull, const shader::CertifiedCell& cell,
                         std::int32_t x, std::int32_t y, std::int32_t z) noexcept {
    const VoxelPoint origin = originOf(x, y, z);
    return partMayMeetLinearly(opaque, hull, cell, origin, partOf(hull, origin, cell));
}

} // namespace voxtact::cpu
