// SPDX-License-Identifier: MIT
#include "cpu/clearance/cell_piece.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

constexpr std::size_t kX = 1;
constexpr std::size_t kY = 2;
constexpr std::size_t kZ = 4;

/// Calls `visit(even, odd)` for the pairs that differ along an axis.
template <class Numbers, class Visit> void alongAxis(Numbers& numbers, std::size_t axis, const Visit& visit) {
    for (std::size_t i = 0; i < 8; ++i) {
        if ((i & axis) == 0) {
            visit(numbers[i], numbers[i | axis]);
        }
    }
}

/// Of sums like those of least(), relative to their largest terms.
constexpr double kSumError = 0x1p-46;

/// The least value of dot(w, s) for s in the cube from -1 to 1 with dot(c, s) >= b, or somewhat less: any multiplier
/// gives such a bound (weak duality), and the greatest is at one of those that are tried.
double leastAbove(const dvec3& w, const dvec3& c, double b) {
    double best = -(std::abs(w.x) + std::abs(w.y) + std::abs(w.z));
    const double size = std::abs(b) + std::abs(c.x) + std::abs(c.y) + std::abs(c.z);
    for (int i = 0; i < 3; ++i) {
        const double multiplier = w[i] / c[i];
        const dvec3 left = w - multiplier * c;
        const double bound =
            multiplier * b - (std::abs(left.x) + std::abs(left.y) + std::abs(left.z)) - kSumError * multiplier * size;
        // Not for NaN either.
        if (multiplier > 0 && bound > best) {
            best = bound;
        }
    }
    return best;
}

} // namespace

Trilinear trilinearOf(const std::array<double, 8>& corners) noexcept {
    Trilinear terms = corners;
    for (const std::size_t axis : {kX, kY, kZ}) {
        alongAxis(terms, axis, [](double& even, double& odd) {
            const double lower = even;
            even = (lower + odd) / 2;
            odd = (odd - lower) / 2;
        });
    }
    return terms;
}

Trilinear within(const Trilinear& whole, const dvec3& middle, const dvec3& half) noexcept {
    Trilinear terms = whole;
    for (int i = 0; i < 3; ++i) {
        alongAxis(terms, std::size_t{1} << static_cast<unsigned>(i), [&](double& even, double& odd) {
            even += middle[i] * odd;
            odd *= half[i];
        });
    }
    return terms;
}

double valueAt(const Trilinear& whole, const dvec3& at) noexcept {
    const double v00 = whole[0] + at.x * whole[kX];
    const double v10 = whole[kY] + at.x * whole[kX + kY];
    const double v01 = whole[kZ] + at.x * whole[kX + kZ];
    const double v11 = whole[kY + kZ] + at.x * whole[kX + kY + kZ];
    return v00 + at.y * v10 + at.z * (v01 + at.y * v11);
}

dvec3 gradientAt(const Trilinear& whole, const dvec3& at) noexcept {
    const double all = whole[kX + kY + kZ];
    return {whole[kX] + at.y * whole[kX + kY] + at.z * (whole[kX + kZ] + at.y * all),
            whole[kY] + at.x * whole[kX + kY] + at.z * (whole[kY + kZ] + at.x * all),
            whole[kZ] + at.x * whole[kX + kZ] + at.y * (whole[kY + kZ] + at.x * all)};
}

CellPiece::CellPiece(const Trilinear& cell, double error, const dvec3& cellMiddle, const dvec3& middle,
                     const dvec3& half) noexcept
    : terms_(within(cell, middle, half)), error_(error), middle_(cellMiddle + 0.5 * middle), half_(0.5 * half) {
    std::array<double, 8> corners = terms_;
    for (const std::size_t axis : {kX, kY, kZ}) {
        alongAxis(corners, axis, [](double& even, double& odd) {
            const double centre = even;
            even = centre - odd;
            odd = centre + odd;
        });
    }
    const auto [least, greatest] = std::minmax_element(corners.begin(), corners.end());
    lo_ = *least - error;
    hi_ = *greatest + error;
    double all = 0; // NaN where a corner is
    for (const double corner : corners) {
        all += corner;
    }
    if (std::isnan(all)) {
        lo_ = all;
        hi_ = all;
    }
}

bool CellPiece::mayBeOpaque(const OpaqueIntervals& intervals) noexcept {
    return intervals.meet(lo_, hi_, hull_);
}

double CellPiece::least(const VolumeSpace& space, const dvec3& normal) const noexcept {
    const dvec3 w = (normal * space.local_from_voxel) * half_;
    const dvec3 c{terms_[kX], terms_[kY], terms_[kZ]};
    // What the linear part may differ from the interpolant.
    const double bent = std::abs(terms_[kX + kY]) + std::abs(terms_[kX + kZ]) + std::abs(terms_[kY + kZ]) +
                        std::abs(terms_[kX + kY + kZ]) + error_;
    double least = -(std::abs(w.x) + std::abs(w.y) + std::abs(w.z));
    if (hull_.lo > lo_) {
        least = std::max(least, leastAbove(w, c, hull_.lo - bent - terms_[0]));
    }
    if (hull_.hi < hi_) {
        least = std::max(least, leastAbove(w, -c, terms_[0] - bent - hull_.hi));
    }
    return dot(normal, space.toWorld(middle_)) + least;
}

dvec3 CellPiece::ascent(const VolumeSpace& space) const noexcept {
    return (dvec3{terms_[kX], terms_[kY], terms_[kZ]} / half_) * space.voxel_from_local;
}

} // namespace voxtact::cpu
