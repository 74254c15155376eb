// SPDX-License-Identifier: MIT
#include "core/method/certified_constants.h"
#include "core/base/enum_check.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/geometry/wide_matrix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace voxtact {

namespace {

/// Relative to the terms of an element of the grid's matrix times its inverse: the maximum error.
constexpr double kInverseError = 0x1p-49;
/// The world's axis that a grid's axis is along.
struct WorldAxis {
    std::size_t axis = 0;
    double sign = 1;
};

/// If the grid's axes are those of the world, possibly permuted or reversed.
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

/// Maximum error of a position in texture space along `row`, relative to a coordinate: the rounding of the inverse of
/// the grid's matrix.
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

shader::CertifiedPair certifiedPair(const shader::PairGrid& grid, const Mat4& world_from_object,
                                    const MeshOrigin& origin) noexcept {
    return shader::certifiedPairOf(grid, toWide(world_from_object), toPairOrigin(origin));
}

namespace {

/// True if division by it is as exact as src/exact/certified_precise.h requires.
bool scaleIsUsable(double scale) {
    return scale >= 0x1p-40 && scale <= 0x1p40;
}

} // namespace

shader::CertifiedItem certifiedItem(const Grid& grid, const OpaqueNumbers& opaque, double resolution) noexcept {
    shader::CertifiedItem item{};
    item.entryScale = opaque.scale;
    item.storedReference = opaque.reference;
    item.threshold = opaque.counts.threshold;
    item.outer = opaque.counts.outer;
    item.inner = opaque.counts.inner;
    item.points = opaque.counts.points;
    item.resolution = static_cast<float>(resolution);
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

} // namespace voxtact
