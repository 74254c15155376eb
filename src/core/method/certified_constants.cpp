// SPDX-License-Identifier: MIT
#include "core/method/certified_constants.h"
#include "core/base/text.h"
#include "core/transfer/table_extremes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace voxtact {

namespace {

/// Rounding of a vertex's difference from the reference, of the matrix to float, of three products and of three sums:
/// in all less than 7 units of 2^-24 of the sum of the terms' magnitudes.
constexpr double kFloatError = 0x1p-21;
/// The products of matrices in double, with the voxels' scale.
constexpr double kDoubleError = 0x1p-48;
/// The smallest normal float. Devices may take what is smaller for zero, wherever they load or compute it.
constexpr double kLeastNormal = 0x1p-126;
/// Such losses of a coordinate of a vertex relative to the reference: it, the reference, their difference; one more
/// for what that adds to the computed error.
constexpr double kLostNormals = 4;
/// Entries a stored value. Up to there, what a device takes for zero is less than 2^-26 of an entry; beyond, it may be
/// an entry and more, in a volume whose voxels are all as small.
constexpr double kMostEntryScale = 0x1p100;
/// Parts of a place are not smaller: all their bits are normal floats, and so is every sum of them.
constexpr double kLeastPart = 0x1p-100;
/// Of the terms of an element of the product of the grid's matrix and its inverse: by what it may be off.
constexpr double kInverseError = 0x1p-49;
/// Object units. A reference beyond it is worse than none.
constexpr double kFarthestReference = 1e12;

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

/// The point of object space that comes to the volume's centre, rounded to float: what is near the volume is then near
/// the reference, however far the object's origin is. The origin where there is no such point.
std::array<float, 3> referenceOf(const Grid& grid, const Mat4& m) {
    const auto minor = [&](std::size_t r, std::size_t c) {
        const std::size_t r1 = (r + 1) % 3;
        const std::size_t r2 = (r + 2) % 3;
        const std::size_t c1 = (c + 1) % 3;
        const std::size_t c2 = (c + 2) % 3;
        return m[4 * c1 + r1] * m[4 * c2 + r2] - m[4 * c2 + r1] * m[4 * c1 + r2];
    };
    const double determinant = m[0] * minor(0, 0) + m[4] * minor(0, 1) + m[8] * minor(0, 2);
    std::array<float, 3> reference{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double sum = 0;
        for (std::size_t row = 0; row < 3; ++row) {
            sum += minor(row, axis) * (0.5 * grid.size[row] - m[12 + row]);
        }
        const double place = sum / determinant;
        if (!(std::abs(place) < kFarthestReference)) {
            return {};
        }
        reference[axis] = static_cast<float>(place);
    }
    return reference;
}

/// a + b, exactly (Knuth).
std::array<double, 2> exactSum(double a, double b) {
    const double sum = a + b;
    const double ofB = sum - a;
    return {sum, (b - ofB) + (a - (sum - ofB))};
}

/// A floating-point number in parts that a float holds each: their sum is exact where what is left is zero.
struct Parts {
    std::array<float, 3> part{};
    double left = 0;
};

/// Of value + low, the second the smaller by far.
Parts partsOf(double value, double low = 0) {
    Parts out;
    double rest = value;
    double lost = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        if (std::abs(rest) >= kLeastPart) {
            out.part[i] = static_cast<float>(rest);
            rest -= static_cast<double>(out.part[i]); // exact: they are near each other
        }
        if (i == 0) {
            const auto [sum, beyond] = exactSum(rest, low);
            rest = sum;
            lost = beyond;
        }
    }
    out.left = std::abs(rest) + std::abs(lost);
    return out;
}

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

/// How far a place in texture space may be off, along an axis for each of the coordinates of a point: what the inverse
/// of the grid's matrix was rounded by.
struct InverseError {
    std::array<std::array<double, 4>, 3> share{}; ///< of the terms of the place along each axis, and one more
};

InverseError inverseError(const Grid& grid, const Mat4& texture_from_world) {
    const Mat4 world_from_texture = worldFromTexture(grid);
    InverseError out;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 4; ++column) {
            double sum = column == 3 ? texture_from_world[12 + row] : 0;
            double magnitude = std::abs(sum);
            for (std::size_t k = 0; k < 3; ++k) {
                const double term = texture_from_world[4 * k + row] * world_from_texture[4 * column + k];
                sum += term;
                magnitude += std::abs(term);
            }
            out.share[row][column] = std::abs(sum - (row == column ? 1 : 0)) + kInverseError * magnitude;
        }
    }
    return out;
}

/// `place` of a CertifiedPair, and by how much it may be off, for each of the coordinates from the reference.
struct Place {
    std::array<std::array<Parts, 4>, 3> rows;
    std::array<double, 4> error{};
};

Place alignedPlace(const Grid& grid, const std::array<WorldAxis, 3>& axes, const Mat4& world_from_object) {
    Place out;
    for (std::size_t row = 0; row < 3; ++row) {
        const auto [axis, sign] = axes[row];
        for (std::size_t column = 0; column < 3; ++column) {
            out.rows[row][column] = partsOf(sign * world_from_object[4 * column + axis]);
            out.error[column] = std::max(out.error[column], out.rows[row][column].left);
        }
        const auto [from, lost] = exactSum(sign * world_from_object[12 + axis], -sign * grid.origin[axis]);
        const auto [place, lostToo] = exactSum(from, grid.spacing[row] / 2);
        const auto [low, left] = exactSum(lostToo, lost);
        out.rows[row][3] = partsOf(place, low);
        out.error[3] = std::max(out.error[3], out.rows[row][3].left + std::abs(left));
    }
    return out;
}

Place obliquePlace(const Grid& grid, const Mat4& texture_from_world, const Rows& rows) {
    const InverseError inverse = inverseError(grid, texture_from_world);
    Place out;
    for (std::size_t row = 0; row < 3; ++row) {
        const double size = grid.size[row];
        for (std::size_t column = 0; column < 4; ++column) {
            const double half = column == 3 ? 0.5 : 0;
            out.rows[row][column] = partsOf(rows.value[4 * column + row] + half);
            double error = kDoubleError * (rows.magnitude[4 * column + row] + half) + out.rows[row][column].left;
            for (std::size_t k = 0; k < 3; ++k) {
                error += size * inverse.share[row][k] * rows.magnitude[4 * column + k] / grid.size[k];
            }
            if (column == 3) {
                error += size * inverse.share[row][3];
            }
            out.error[column] = std::max(out.error[column], error);
        }
    }
    return out;
}

/// Expects the rest of the pair.
void addPlace(const Place& place, shader::CertifiedPair& pair) {
    std::array<double, 4> error = place.error;
    double share = 0;
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t part = 0; part < 3; ++part) {
                pair.place[3 * part + row][column] = place.rows[row][column].part[part];
            }
        }
        if (column < 3) {
            error[3] += error[column] * std::abs(static_cast<double>(pair.reference[column]));
        }
        share = std::max(share, error[column] / static_cast<double>(pair.error[column]));
    }
    pair.reference[3] = share > 0 ? roundedUp(1.001 * share + kLeastNormal) : 0;
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
    const std::array<float, 3> reference = referenceOf(grid, rows.value);
    shader::CertifiedPair out{};
    std::array<double, 4> worst{};
    bool fits = true; // in floats: an element that is infinite or NaN has no relative error
    for (std::size_t row = 0; row < 3; ++row) {
        double place = rows.value[12 + row];
        double magnitude = rows.magnitude[12 + row];
        double lost = 0;
        for (std::size_t column = 0; column < 3; ++column) {
            const double element = rows.value[4 * column + row];
            place += element * static_cast<double>(reference[column]);
            magnitude += rows.magnitude[4 * column + row] * std::abs(static_cast<double>(reference[column]));
            lost += kLostNormals * kLeastNormal * std::abs(element);
            out.voxel_from_reference[row][column] = static_cast<float>(element);
            worst[column] = std::max(worst[column],
                                     kFloatError * std::abs(element) + kDoubleError * rows.magnitude[4 * column + row]);
        }
        out.voxel_from_reference[row][3] = static_cast<float>(place);
        for (std::size_t column = 0; column < 4; ++column) {
            fits = fits && std::isfinite(out.voxel_from_reference[row][column]);
        }
        worst[3] = std::max(worst[3], kFloatError * std::abs(place) + kDoubleError * magnitude + lost);
    }
    std::copy(reference.begin(), reference.end(), out.reference.begin());
    for (std::size_t column = 0; column < 4; ++column) {
        // Elements below the smallest normal float lose more than their relative error.
        out.error[column] = roundedUp(worst[column] + 0x1p-120);
    }
    if (!fits) {
        out.error[3] = std::numeric_limits<float>::infinity();
    }
    const std::optional<std::array<WorldAxis, 3>> axes = worldAxes(grid);
    addPlace(axes ? alignedPlace(grid, *axes, world_from_object) : obliquePlace(grid, texture_from_world, rows), out);
    return out;
}

namespace {

/// Whether entry coordinates are as exact as shaders/certified_cell.h says, also where denormals are taken for zero.
bool entriesAreKnown(double entryScale, double threshold) {
    const double magnitude = std::abs(entryScale);
    // Comparing opacities with a threshold that is taken for zero calls all of them opaque.
    return magnitude >= kLeastNormal && magnitude <= kMostEntryScale && (threshold == 0 || threshold >= kLeastNormal);
}

} // namespace

namespace {

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
        const Parts scale = partsOf(aligned ? grid.spacing[axis] : 1);
        for (std::size_t part = 0; part < 3; ++part) {
            item.scale[3 * part + axis] = scale.left == 0 && scaleIsUsable(grid.spacing[axis])
                                              ? scale.part[part]
                                              : std::numeric_limits<float>::quiet_NaN();
        }
    }
    return item;
}

} // namespace voxtact
