// SPDX-License-Identifier: MIT
#include "core/method/certified_constants.h"
#include "core/base/enum_check.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/geometry/rigid_motion.h"
#include "core/geometry/vec3.h"
#include "core/geometry/wide_matrix.h"
#include "core/transfer/table_extremes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace voxtact {

namespace {

/// Devices may take what is smaller for zero, wherever they load or compute it.
constexpr double kLeastNormal = std::numeric_limits<float>::min();
/// Entries a stored value. Up to there, what a device takes for zero is less than 2^-26 of an entry; beyond, it may be
/// an entry and more, in a volume whose voxels are all as small.
constexpr double kMostEntryScale = 0x1p100;
/// Of the terms of an element of the product of the grid's matrix and its inverse: by what it may be off.
constexpr double kInverseError = 0x1p-49;
/// The world's axis that a grid's axis is along.
struct WorldAxis {
    std::size_t axis = 0;
    double sign = 1;
};

/// Where the grid's axes are those of the world, in another order or direction.
std::optional<std::array<WorldAxis, 3>> worldAxes(const Grid& grid) {
    std::array<WorldAxis, 3> out;
    for (std::size_t column = 0; column < 3; ++column) {
        std::size_t others = 0;
        for (std::size_t row = 0; row < 3; ++row) {
            const double element = grid.direction[3 * column + row];
            if (std::abs(element) == 1) {
                out[column] = {row, element};
            }
            others += element == 0 ? 1U : 0U;
        }
        if (others != 2 || std::abs(grid.direction[3 * column + out[column].axis]) != 1) {
            return {};
        }
    }
    return out;
}

/// By how much a place in texture space may be off along `row`, of the magnitude of a coordinate: by what the inverse
/// of the grid's matrix was rounded.
double inverseError(const Mat4& texture_from_world, const Mat4& world_from_texture, std::size_t row,
                    std::size_t column) {
    double sum = column == 3 ? texture_from_world[12 + row] : 0;
    double magnitude = std::abs(sum);
    for (std::size_t k = 0; k < 3; ++k) {
        const double term = texture_from_world[4 * k + row] * world_from_texture[4 * column + k];
        sum += term;
        magnitude += std::abs(term);
    }
    return std::abs(sum - (row == column ? 1 : 0)) + kInverseError * magnitude;
}

} // namespace

Result<void> checkResolution(double resolution) {
    if (!(resolution >= 0x1p-12 && resolution <= 1)) {
        return refuse("the resolution " + number(resolution) + " is outside of 1/4096 to 1 voxel");
    }
    return {};
}

shader::PairGrid pairGrid(const Grid& grid, const Mat4& texture_from_world) noexcept {
    shader::PairGrid out{};
    out.texture_from_world = toWide(texture_from_world);
    const std::optional<std::array<WorldAxis, 3>> axes = worldAxes(grid);
    out.aligned = axes ? 1 : 0;
    const Mat4 world_from_texture = worldFromTexture(grid);
    for (std::size_t row = 0; row < 3; ++row) {
        out.size[row] = grid.size[row];
        if (axes) {
            const auto [axis, sign] = (*axes)[row];
            out.axis[row] = static_cast<std::uint32_t>(axis);
            out.sign[row] = sign;
            out.lessOrigin[row] = -sign * grid.origin[axis];
            out.halfSpacing[row] = grid.spacing[row] / 2;
            continue;
        }
        for (std::size_t column = 0; column < 4; ++column) {
            const double voxels = column == 3 ? 1 : grid.size[column];
            out.share[4 * row + column] =
                out.size[row] * inverseError(texture_from_world, world_from_texture, row, column) / voxels;
        }
    }
    return out;
}

shader::CertifiedPair certifiedPair(const shader::PairGrid& grid, const Mat4& world_from_object) noexcept {
    return shader::certifiedPairOf(grid, toWide(world_from_object));
}

namespace {

/// Whether entry coordinates are as exact as shaders/certified_cell.h says, also where denormals are taken for zero.
bool entriesAreKnown(double entryScale, double threshold) {
    const double magnitude = std::abs(entryScale);
    // Comparing opacities with a threshold that is taken for zero calls all of them opaque.
    return magnitude >= kLeastNormal && magnitude <= kMostEntryScale && (threshold == 0 || threshold >= kLeastNormal);
}

/// Whether a place divided by it is as exact as shaders/certified_precise.h says.
bool scaleIsUsable(double scale) {
    return scale >= 0x1p-40 && scale <= 0x1p40;
}

} // namespace

shader::CertifiedItem certifiedItem(const Grid& grid, double slope, double intercept, const ValueRange& domain,
                                    std::size_t tableSize, double threshold, double resolution) noexcept {
    const double width = domain.hi - domain.lo;
    const auto entries = static_cast<double>(tableSize);
    // A whole number, which the difference of an integer voxel and it is, too.
    const double middle = std::round((domain.lo / 2 + domain.hi / 2 - intercept) / slope);
    const float reference = std::abs(middle) < 0x1p24 ? static_cast<float>(middle) : 0;
    shader::CertifiedItem item{};
    const double entryScale = slope / width * entries;
    // NaN is any entry of the table: what may be opaque is *possible*.
    item.entryScale = entriesAreKnown(entryScale, threshold) ? static_cast<float>(entryScale)
                                                             : std::numeric_limits<float>::quiet_NaN();
    item.entryBias =
        static_cast<float>((slope * static_cast<double>(reference) + intercept - domain.lo) / width * entries - 0.5);
    item.storedReference = reference;
    item.threshold = static_cast<float>(threshold);
    item.resolution = static_cast<float>(resolution);
    item.tableSize = static_cast<int>(tableSize);
    item.tableLevels = static_cast<int>(TableExtremes::levelsOf(tableSize));
    item.sizeX = static_cast<int>(grid.size[0]);
    item.sizeY = static_cast<int>(grid.size[1]);
    item.sizeZ = static_cast<int>(grid.size[2]);
    const bool aligned = worldAxes(grid).has_value();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const shader::PairParts scale = shader::pairParts(aligned ? grid.spacing[axis] : 1, 0);
        for (std::size_t part = 0; part < 3; ++part) {
            item.scale[3 * part + axis] = scale.left == 0 && scaleIsUsable(grid.spacing[axis])
                                              ? scale.part[part]
                                              : std::numeric_limits<float>::quiet_NaN();
        }
    }
    return item;
}

namespace {

constexpr double kMostMargin = 1e6; // mm, on a device

} // namespace

Result<void> checkMargin(double margin) {
    if (!(margin >= 0 && margin <= kMostMargin)) {
        return refuse("the margin " + number(margin) + " mm is not a number from 0 to 1000000");
    }
    return {};
}

namespace {

/// a less what of it is along the unit vector `along`.
Vec3 across(const Vec3& a, const Vec3& along) {
    const double part = dot(a, along);
    return {a[0] - part * along[0], a[1] - part * along[1], a[2] - part * along[2]};
}

/// The sides of a voxel, world mm.
std::array<Vec3, 3> voxelSides(const Grid& grid) {
    std::array<Vec3, 3> sides{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t row = 0; row < 3; ++row) {
            sides[axis][row] = grid.direction[3 * axis + row] * grid.spacing[axis];
        }
    }
    return sides;
}

} // namespace

double longestSide(const Grid& grid) noexcept {
    double longest = 0;
    for (const Vec3& side : voxelSides(grid)) {
        longest = std::max(longest, length(side));
    }
    return longest;
}

std::array<double, 3> voxelsOfMargin(const Grid& grid, double margin) noexcept {
    const std::array<Vec3, 3> sides = voxelSides(grid);
    std::array<double, 3> out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // How far the side rises over the plane of the two others.
        const Vec3 first = unit(sides[(axis + 1) % 3]);
        const Vec3 second = unit(across(sides[(axis + 2) % 3], first));
        const Vec3 rise = across(across(sides[axis], first), second);
        out[axis] = margin / std::sqrt(dot(rise, rise));
    }
    return out;
}

shader::CertifiedItem withMargin(shader::CertifiedItem item, const Grid& grid, double margin) noexcept {
    constexpr double kOutward = 1 + 0x1p-18; // more than rounding here, to float, and in the sums of marginBounds()
    const std::array<Vec3, 3> sides = voxelSides(grid);
    const double longest = longestSide(grid);
    const Vec3 x = unit(sides[0]);
    const Vec3 y = unit(across(sides[1], x));
    const Vec3 z = unit(across(across(sides[2], x), y));
    const std::array<double, 6> flat{dot(x, sides[0]), dot(x, sides[1]), dot(x, sides[2]),
                                     dot(y, sides[1]), dot(y, sides[2]), dot(z, sides[2])};
    for (std::size_t i = 0; i < flat.size(); ++i) {
        item.scale[i] = static_cast<float>(flat[i] / longest);
    }
    const std::array<double, 3> grow = voxelsOfMargin(grid, margin);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        item.scale[6 + axis] = static_cast<float>(grow[axis] * kOutward);
    }
    item.resolution = static_cast<float>(margin / longest);
    return item;
}

shader::CertifiedItem withTolerance(shader::CertifiedItem item, const Grid& grid, double distance) noexcept {
    const double side = longestSide(grid);
    item = withMargin(item, grid, side);
    item.resolution = static_cast<float>(distance / side);
    return item;
}

shader::CertifiedItem withClearance(shader::CertifiedItem item, const Grid& grid, double tolerance) noexcept {
    constexpr double kLeft = 0.75;      // the rest is for roundings
    constexpr double kFinest = 0x1p-10; // voxels; single precision tells no less apart
    const double side = longestSide(grid);
    item = withMargin(item, grid, side);
    item.resolution = static_cast<float>(std::max(kLeft * tolerance / side, kFinest));
    return item;
}

shader::CertifiedItem withAnyOpacity(shader::CertifiedItem item) noexcept {
    item.entryScale = 0; // all values are alike, and certain
    item.entryBias = 0;
    item.threshold = -1;
    return item;
}

Result<void> checkTolerance(const PoseTolerance& tolerance) {
    if (!(tolerance.distance >= 0 && std::isfinite(tolerance.distance))) {
        return refuse("the distance " + number(tolerance.distance) + " mm of the tolerance is not a number from 0 on");
    }
    if (!(tolerance.angle >= 0 && tolerance.angle <= 180)) {
        return refuse("the angle " + number(tolerance.angle) + " degrees of the tolerance is outside of 0 to 180");
    }
    return {};
}

Result<void> checkDeviceTolerance(const PoseTolerance& tolerance) {
    VOXTACT_TRY(checkTolerance(tolerance));
    if (tolerance.distance > kMostMargin) {
        return refuse("the distance " + number(tolerance.distance) + " mm of the tolerance is above " +
                      number(kMostMargin) + " mm, the most on a device");
    }
    return {};
}

Result<void> checkMotion(const MotionSearch& search) {
    constexpr double kLeastResolution = 1e-6;
    if (!(search.resolution >= kLeastResolution && std::isfinite(search.resolution))) {
        return refuse("the resolution " + number(search.resolution) + " mm is not a number from " +
                      number(kLeastResolution) + " mm on");
    }
    return checkInterpolation(search.interpolation);
}

Result<void> checkTolerance(double tolerance) {
    constexpr double kLeastTolerance = 1e-6;
    if (!(tolerance >= kLeastTolerance && tolerance < kInfinity)) {
        return refuse("the tolerance " + number(tolerance) + " mm is not a number from " + number(kLeastTolerance) +
                      " mm on");
    }
    return {};
}

Result<void> checkMaximum(double maximum) {
    if (!(maximum > 0)) {
        return refuse("the maximum clearance " + number(maximum) + " mm is not above 0");
    }
    return {};
}

} // namespace voxtact
