// SPDX-License-Identifier: MIT
#include "core/volume/ball_rows.h"
#include "core/base/exact_number.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact {

namespace {

double length(const Vec3& a) {
    return std::hypot(a[0], a[1], a[2]);
}

/// Voxel numbers along an axis.
struct Span {
    std::uint32_t first = 0;
    std::uint32_t end = 0;
};

/// Returns the numbers from `lo` to `hi` of an axis with `size` voxels. NaN means no limit.
Span numbersWithin(double lo, double hi, std::uint32_t size) {
    const double most = size;
    const double first = lo > 0 ? std::min(std::ceil(lo), most) : 0;
    const double end = hi < most - 1 ? std::max(std::floor(hi) + 1, 0.0) : most;
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(std::max(first, end))};
}

/// More than the rounding of eight operations, relative to their largest term.
constexpr double kRounding = 0x1p-49;
/// More than what any product here loses below the smallest normal double.
constexpr double kLost = 1e-290;
/// Maximum relative error of the numbers that give a position in index space.
constexpr double kPlaceError = 1e-9;

/// Returns the first number from `first` to `end` for which a monotonic condition holds; `end` if none.
template <class Condition> std::uint32_t leastThat(std::uint32_t first, std::uint32_t end, const Condition& holds) {
    while (first < end) {
        const std::uint32_t middle = first + (end - first) / 2;
        if (holds(middle)) {
            end = middle;
        } else {
            first = middle + 1;
        }
    }
    return first;
}

/// A row of voxels along x. The distance from the ball's centre, squared, is convex along it.
class Row {
  public:
    Row(const Ball& ball, const Grid& grid, const Mat4& world_from_index, std::uint32_t y, std::uint32_t z)
        : ball_(ball), grid_(grid), number_{0, y, z} {
        for (std::size_t i = 0; i < 3; ++i) {
            const double alongY = world_from_index[4 + i] * y;
            const double alongZ = world_from_index[8 + i] * z;
            from_[i] = (grid.origin[i] - ball.centre[i]) + alongY + alongZ;
            terms_[i] = std::abs(grid.origin[i]) + std::abs(ball.centre[i]) + std::abs(alongY) + std::abs(alongZ);
            step_[i] = world_from_index[i];
        }
    }

    /// The voxels within the ball.
    [[nodiscard]] Span span() const {
        const std::uint32_t size = grid_.size[0];
        const double steps = 1 / (step_[0] * step_[0] + step_[1] * step_[1] + step_[2] * step_[2]);
        const double nearest = -(from_[0] * step_[0] + from_[1] * step_[1] + from_[2] * step_[2]) * steps;
        Vec3 across{};
        for (std::size_t i = 0; i < 3; ++i) {
            across[i] = from_[i] + nearest * step_[i];
        }
        const double squared =
            ball_.radius * ball_.radius - (across[0] * across[0] + across[1] * across[1] + across[2] * across[2]);
        const double half = std::sqrt(squared * steps);
        const Span guess = squared >= 0 ? numbersWithin(nearest - half, nearest + half, size) : Span{};
        if (guess.first < guess.end ? isSpan(guess) : isMissed(nearest)) {
            return guess.first < guess.end ? guess : Span{};
        }
        return searched();
    }

  private:
    [[nodiscard]] bool isSpan(const Span& guess) const {
        return inside(guess.first) && inside(guess.end - 1) && (guess.first == 0 || !inside(guess.first - 1)) &&
               (guess.end == grid_.size[0] || !inside(guess.end));
    }

    /// True if no voxel is inside, shown by those around the nearest one. A voxel on either side may lie exactly at the
    /// minimum distance, and is not tested.
    [[nodiscard]] bool isMissed(double nearest) const {
        const std::uint32_t last = grid_.size[0] - 1;
        const auto about =
            nearest > 0 ? static_cast<std::uint32_t>(std::min(std::round(nearest), static_cast<double>(last))) : 0;
        const std::uint32_t first = about - std::min(about, 1U);
        const std::uint32_t end = std::min(about, last - 1) + 1;
        for (std::uint32_t x = first; x <= std::min(end, last); ++x) {
            if (inside(x)) {
                return false;
            }
        }
        return (first == 0 || !rises(first)) && (end >= last || rises(end));
    }

    /// For any guess.
    [[nodiscard]] Span searched() const {
        const std::uint32_t size = grid_.size[0];
        const std::uint32_t rising = leastThat(0, size, [this](std::uint32_t x) { return rises(x); });
        const std::uint32_t near = rising < size && inside(rising) ? rising : rising - std::min(rising, 1U);
        if (!inside(near)) {
            return {};
        }
        return {leastThat(0, near, [this](std::uint32_t x) { return inside(x); }),
                leastThat(near + 1, size, [this](std::uint32_t x) { return !inside(x); })};
    }

    /// True if a voxel's centre is in the ball.
    [[nodiscard]] bool inside(std::uint32_t x) const {
        double sum = 0;
        double error = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const double off = errorAt(i, x);
            const double at = from_[i] + step_[i] * x;
            sum += at * at;
            error += (2 * std::abs(at) + off) * off;
        }
        const double radius = ball_.radius * ball_.radius;
        error += kRounding * (sum + radius) + kLost;
        if (std::abs(sum - radius) > error) {
            return sum < radius;
        }
        ExactNumber beyond = ExactNumber(0) - ExactNumber(ball_.radius) * ExactNumber(ball_.radius);
        for (std::size_t i = 0; i < 3; ++i) {
            const ExactNumber at = exactly(i, x);
            beyond = beyond + at * at;
        }
        return beyond.sign() <= 0;
    }

    /// True if the distance does not decrease towards the next voxel: its derivative is not negative.
    [[nodiscard]] bool rises(std::uint32_t x) const {
        double sum = 0;
        double error = kLost;
        for (std::size_t i = 0; i < 3; ++i) {
            const double part = (from_[i] + step_[i] * x) * step_[i];
            sum += part;
            error += std::abs(step_[i]) * errorAt(i, x) + kRounding * std::abs(part);
        }
        if (std::abs(sum) > error) {
            return sum > 0;
        }
        ExactNumber slope(0);
        for (std::size_t i = 0; i < 3; ++i) {
            slope = slope + exactly(i, x) * ExactNumber(grid_.direction[i]) * ExactNumber(grid_.spacing[0]);
        }
        return slope.sign() >= 0;
    }

    /// Coordinate of the vector from the ball's centre to a voxel's centre.
    [[nodiscard]] double errorAt(std::size_t i, std::uint32_t x) const {
        return kRounding * (terms_[i] + std::abs(step_[i]) * x);
    }

    [[nodiscard]] ExactNumber exactly(std::size_t i, std::uint32_t x) const {
        ExactNumber at = ExactNumber(grid_.origin[i]) - ExactNumber(ball_.centre[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at = at + ExactNumber(grid_.direction[3 * axis + i]) * ExactNumber(grid_.spacing[axis]) *
                          ExactNumber(axis == 0 ? x : number_[axis]);
        }
        return at;
    }

    const Ball& ball_;
    const Grid& grid_;
    std::array<std::uint32_t, 3> number_; ///< of the row's first voxel
    Vec3 from_{};                         ///< from the ball's centre to it
    Vec3 terms_{};                        ///< magnitudes of the terms of that sum
    Vec3 step_{};                         ///< from one voxel to the next
};

/// Voxels of an axis between which the ball lies, generously.
Span reach(const Ball& ball, const Grid& grid, const Mat4& texture_from_world, std::size_t axis) {
    const double voxels = grid.size[axis];
    const double at = transformPoint(texture_from_world, ball.centre)[axis] * voxels - 0.5;
    const Vec3 row{texture_from_world[axis], texture_from_world[4 + axis], texture_from_world[8 + axis]};
    double terms = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        terms += std::abs(row[i]) * (std::abs(ball.centre[i]) + std::abs(grid.origin[i]));
    }
    const double half = (ball.radius * length(row) * 1.001 + kPlaceError * terms) * voxels + 1;
    return numbersWithin(at - half, at + half, grid.size[axis]);
}

} // namespace

std::vector<VoxelRow> ballRows(const Ball& ball, const Grid& grid) {
    const Mat4 world_from_index = worldFromIndex(grid);
    const Mat4 texture_from_world = textureFromWorld(grid).value();
    const Span spanY = reach(ball, grid, texture_from_world, 1);
    const Span spanZ = reach(ball, grid, texture_from_world, 2);
    std::vector<VoxelRow> rows;
    for (std::uint32_t z = spanZ.first; z < spanZ.end; ++z) {
        for (std::uint32_t y = spanY.first; y < spanY.end; ++y) {
            if (const Span span = Row(ball, grid, world_from_index, y, z).span(); span.first < span.end) {
                rows.push_back({y, z, span.first, span.end});
            }
        }
    }
    return rows;
}

} // namespace voxtact
