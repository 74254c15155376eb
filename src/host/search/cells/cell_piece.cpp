// SPDX-License-Identifier: MIT
#include "host/search/cells/cell_piece.h"
#include "core/base/infinity.h"

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

PieceBounds CellPiece::bounds(const VolumeSpace& space) const noexcept {
    const dvec3 slope{terms_[kX], terms_[kY], terms_[kZ]};
    // Maximum difference of the linear part and the interpolant.
    const double bent = std::abs(terms_[kX + kY]) + std::abs(terms_[kX + kZ]) + std::abs(terms_[kY + kZ]) +
                        std::abs(terms_[kX + kY + kZ]) + error_;
    return {space.toWorld(middle_),
            half_,
            slope,
            1.0 / slope,
            hull_.lo > lo_ ? hull_.lo - bent - terms_[0] : -kInfinity,
            hull_.hi < hi_ ? hull_.hi + bent - terms_[0] : kInfinity,
            std::abs(slope.x) + std::abs(slope.y) + std::abs(slope.z)};
}

/// Minimum of dot(w, s) in the cube from -1 to 1: a plane times any multiplier of its sign gives a bound (weak
/// duality). The maximum is at one of the tested multipliers, or without a plane.
double PieceBounds::least(const VolumeSpace& space, const dvec3& normal) const noexcept {
    const dvec3 w = (normal * space.local_from_voxel) * half;
    double best = -(std::abs(w.x) + std::abs(w.y) + std::abs(w.z));
    for (int i = 0; i < 3; ++i) {
        const double multiplier = w[i] * inverse[i];
        const double plane = multiplier > 0 ? from : to;
        const dvec3 left = w - multiplier * slope;
        const double bound = multiplier * plane - (std::abs(left.x) + std::abs(left.y) + std::abs(left.z)) -
                             kSumError * std::abs(multiplier) * (std::abs(plane) + size);
        // False for NaN, too.
        if (bound > best) {
            best = bound;
        }
    }
    return dot(normal, middle) + best;
}

dvec3 CellPiece::ascent(const VolumeSpace& space) const noexcept {
    return (dvec3{terms_[kX], terms_[kY], terms_[kZ]} / half_) * space.voxel_from_local;
}

} // namespace voxtact::cpu
