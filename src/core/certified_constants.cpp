// SPDX-License-Identifier: MIT
#include "core/certified_constants.h"
#include "core/table_extremes.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact {

namespace {

/// Rounding of the matrix to float, of three products and of three sums, in all less than 6 units of 2^-24 of the sum
/// of the terms' magnitudes.
constexpr double kFloatError = 0x1p-21;
/// The products of matrices in double, with the voxels' scale.
constexpr double kDoubleError = 0x1p-49;

struct Rows {
    Mat4 value;     ///< voxel_from_object; the last row is not used
    Mat4 magnitude; ///< the same product of the elements' magnitudes
};

Rows voxelFromObject(const Grid& grid, const Mat4& texture_from_world, const Mat4& world_from_object) {
    Rows rows{};
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 3; ++row) {
            double sum = 0;
            double magnitude = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                const double term = texture_from_world[4 * k + row] * world_from_object[4 * column + k];
                sum += term;
                magnitude += std::abs(term);
            }
            const double size = grid.size[row];
            const double centre = column == 3 ? 0.5 : 0;
            rows.value[4 * column + row] = sum * size - centre;
            rows.magnitude[4 * column + row] = magnitude * size + centre;
        }
    }
    return rows;
}

float roundedUp(double value) {
    return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

} // namespace

Result<void> checkResolution(double resolution) {
    if (!(resolution >= 0x1p-12 && resolution <= 1)) {
        return Error{ErrorCode::InvalidArgument, 0,
                     "the resolution " + number(resolution) + " is outside of 1/4096 to 1 voxel"};
    }
    return {};
}

shader::CertifiedPair certifiedPair(const Grid& grid, const Mat4& texture_from_world,
                                    const Mat4& world_from_object) noexcept {
    const Rows rows = voxelFromObject(grid, texture_from_world, world_from_object);
    shader::CertifiedPair out{};
    for (std::size_t column = 0; column < 4; ++column) {
        double worst = 0;
        for (std::size_t row = 0; row < 3; ++row) {
            const double value = rows.value[4 * column + row];
            out.voxel_from_object[row][column] = static_cast<float>(value);
            worst = std::max(worst, kFloatError * std::abs(value) + kDoubleError * rows.magnitude[4 * column + row]);
        }
        // Elements below the smallest normal float lose more than their relative error.
        out.error[column] = roundedUp(worst + 0x1p-120);
    }
    return out;
}

shader::CertifiedItem certifiedItem(const Grid& grid, double slope, double intercept, const ValueRange& domain,
                                    std::size_t tableSize, double threshold, double resolution) noexcept {
    const double width = domain.hi - domain.lo;
    const auto entries = static_cast<double>(tableSize);
    // A whole number, which the difference of an integer voxel and it is, too.
    const double middle = std::round((domain.lo / 2 + domain.hi / 2 - intercept) / slope);
    const float reference = std::abs(middle) < 0x1p24 ? static_cast<float>(middle) : 0;
    shader::CertifiedItem item{};
    item.entryScale = static_cast<float>(slope / width * entries);
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
    return item;
}

} // namespace voxtact
