// SPDX-License-Identifier: MIT
#include "host/plan/direction_grid.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

constexpr std::uint32_t kColumns = 5; ///< of an upper and a lower rhombus each

/// Coordinates of the two rings of an icosahedron's corners, between its poles at +-z.
dvec3 ringCorner(bool upper, std::uint32_t column) {
    const double height = (upper ? 1 : -1) / std::sqrt(5.0);
    const double radius = 2 / std::sqrt(5.0);
    const double turn = 2 * glm::pi<double>() / kColumns * (column % kColumns + (upper ? 0 : 0.5));
    return {radius * std::cos(turn), radius * std::sin(turn), height};
}

} // namespace

DirectionGrid::DirectionGrid(std::uint32_t directions) {
    while (count() < directions) {
        ++side_;
    }
    for (std::uint32_t column = 0; column < kColumns; ++column) {
        const dvec3 left = ringCorner(true, column);
        const dvec3 right = ringCorner(true, column + 1);
        const dvec3 below = ringCorner(false, column);
        corners_[column] = {dvec3(0, 0, 1), left, right, below};
        corners_[kColumns + column] = {right, below, ringCorner(false, column + 1), dvec3(0, 0, -1)};
    }
}

/// Each rhombus owns the vertices from (1, 0) to (n, n - 1); the poles are the first two.
std::uint32_t DirectionGrid::number(std::uint32_t rhombus, std::uint32_t i, std::uint32_t j) const noexcept {
    const std::uint32_t n = side_;
    const std::uint32_t column = rhombus % kColumns;
    const std::uint32_t next = (column + 1) % kColumns;
    if (i > 0 && j < n) {
        return 2 + (rhombus * n + i - 1) * n + j;
    }
    if (rhombus < kColumns) {
        return i > 0 ? number(kColumns + column, i, 0) : j == 0 ? 0 : number(next, j, 0);
    }
    if (i == 0) {
        return j < n ? number(next, n, j) : number(kColumns + next, n, 0);
    }
    return i == n ? 1 : number(kColumns + next, n, i);
}

dvec3 DirectionGrid::at(std::uint32_t rhombus, std::uint32_t i, std::uint32_t j) const noexcept {
    const auto& [first, right, up, last] = corners_[rhombus];
    const double x = static_cast<double>(i) / side_;
    const double y = static_cast<double>(j) / side_;
    return glm::normalize(i + j <= side_ ? first + x * (right - first) + y * (up - first)
                                         : last + (1 - x) * (up - last) + (1 - y) * (right - last));
}

dvec3 DirectionGrid::direction(std::uint32_t number) const noexcept {
    if (number < 2) {
        return {0, 0, number == 0 ? 1 : -1};
    }
    const std::uint32_t own = number - 2;
    return at(own / (side_ * side_), own / side_ % side_ + 1, own % side_);
}

std::array<std::array<std::uint32_t, 3>, 2> DirectionGrid::triangles(std::uint32_t rhombus, std::uint32_t i,
                                                                     std::uint32_t j) const noexcept {
    const std::uint32_t right = number(rhombus, i + 1, j);
    const std::uint32_t up = number(rhombus, i, j + 1);
    return {{{number(rhombus, i, j), right, up}, {number(rhombus, i + 1, j + 1), up, right}}};
}

/// The patch is flat except at the ridge, so it lies in the convex hull of its corners and of the points where the
/// ridge meets its edges. A cone of less than a right angle that contains points contains their hull.
DirectionCone DirectionGrid::cone(const DirectionPatch& patch) const {
    constexpr double kRounding = 1e-9; // radians, much more than all roundings here and in entries
    const auto& lo = patch.lo;
    const auto& hi = patch.hi;
    std::vector<dvec3> corners;
    const auto add = [&](std::uint32_t i, std::uint32_t j) {
        if (i >= lo[0] && i <= hi[0] && j >= lo[1] && j <= hi[1]) {
            corners.push_back(direction(number(patch.rhombus, i, j)));
        }
    };
    for (const std::uint32_t i : {lo[0], hi[0]}) {
        add(i, lo[1]);
        add(i, hi[1]);
        add(i, side_ - i);
    }
    for (const std::uint32_t j : {lo[1], hi[1]}) {
        add(side_ - j, j);
    }
    dvec3 sum(0);
    for (const dvec3& corner : corners) {
        sum += corner;
    }
    DirectionCone out{glm::normalize(sum), 0};
    for (const dvec3& corner : corners) {
        out.angle = std::max(out.angle, 2 * std::asin(std::min(0.5 * glm::distance(corner, out.axis), 1.0)));
    }
    out.angle += kRounding;
    return out;
}

} // namespace voxtact::cpu
