// SPDX-License-Identifier: MIT
#include "core/base/text.h"

#include "core/base/try.h"
#include "io/errors.h"
#include "io/volume/nifti_header.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

std::string rounded(double value) {
    return number(std::round(value * 1000) / 1000);
}

/// xyzt_units: the lower three bits. A file that does not say it means millimetres, as every reader takes it.
std::optional<double> millimetresPerUnit(std::int32_t units) {
    switch (units & 7) {
    case 0:
    case 2:
        return 1.0;
    case 1:
        return 1e3;
    case 3:
        return 1e-3;
    default:
        return std::nullopt;
    }
}

Result<void> checkFinite(const fs::path& path, const std::string& name, double value) {
    if (std::isfinite(value)) {
        return {};
    }
    return cannotRead(path, "its NIfTI header is damaged: " + name + " is " + (std::isnan(value) ? "NaN" : "infinite") +
                                "; mend it");
}

/// Every number that says where the image is, whether or not it is the one that counts: a header with one that is
/// none is not to be trusted.
Result<void> checkNumbers(const fs::path& path, const NiftiHeader& header) {
    // Analyze does not use pixdim[0].
    for (std::size_t i = header.kind == NiftiHeader::Kind::Analyze ? 1 : 0; i < header.pixdim.size(); ++i) {
        VOXTACT_TRY(checkFinite(path, "pixdim[" + std::to_string(i) + "]", header.pixdim[i]));
    }
    constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
    constexpr std::array<const char*, 3> kQuaternion{"b", "c", "d"};
    for (std::size_t i = 0; i < 3; ++i) {
        if (header.qformCode > 0) {
            VOXTACT_TRY(checkFinite(path, std::string("quatern_") + kQuaternion[i], header.quaternion[i]));
            VOXTACT_TRY(checkFinite(path, std::string("qoffset_") + kAxes[i], header.qoffset[i]));
        }
        for (std::size_t column = 0; column < 4 && header.sformCode > 0; ++column) {
            const std::string name = std::string("srow_") + kAxes[i] + "[" + std::to_string(column) + "]";
            VOXTACT_TRY(checkFinite(path, name, header.srow[i][column]));
        }
    }
    return {};
}

/// RAS in the file's units.
struct Place {
    AffineSteps affine;
    double doubt = 0; ///< radians that rounding may have turned it by
};

/// nibabel's rules: a size that is negative loses its sign, one that is 0 is 1.
Vec3 voxelSizes(const NiftiHeader& header, std::vector<std::string>& notes) {
    Vec3 sizes{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double size = header.pixdim[axis + 1];
        sizes[axis] = size == 0 ? 1 : std::abs(size);
        if (size <= 0) {
            notes.push_back("the file's pixdim[" + std::to_string(axis + 1) + "], the distance of its voxels, is " +
                            number(size) + "; " + number(sizes[axis]) + " is taken");
        }
    }
    return sizes;
}

/// Keeps the matrix. The spacing is pixdim if they differ only by rounding, so a spacing of 1 is 1.
Place sformPlace(const NiftiHeader& header) {
    Place place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3& step = place.affine.directions[axis];
        step = {header.srow[0][axis], header.srow[1][axis], header.srow[2][axis]};
        const double norm = std::hypot(step[0], step[1], step[2]);
        const double length = std::abs(header.pixdim[axis + 1]);
        constexpr double kRounding = 5e-7; // of floats
        if (std::abs(norm - length) <= kRounding * norm && length > 0) {
            place.affine.lengths[axis] = length;
            for (double& component : step) {
                component /= length;
            }
        }
        place.affine.origin[axis] = header.srow[axis][3];
    }
    return place;
}

/// NIfTI's method 2: a unit quaternion by its last three numbers, the first being positive.
Result<Place> qformPlace(const fs::path& path, const NiftiHeader& header, const Vec3& sizes) {
    const auto [b, c, d] = header.quaternion;
    const double epsilon = header.kind == NiftiHeader::Kind::Nifti2
                               ? std::numeric_limits<double>::epsilon()
                               : static_cast<double>(std::numeric_limits<float>::epsilon());
    const double rest = 1 - (b * b + c * c + d * d);
    if (rest < -3 * epsilon) {
        return cannotRead(path, "its NIfTI header is damaged: its quaternion is longer than 1 (its square is " +
                                    rounded(1 - rest) + ")");
    }
    const double a = std::sqrt(std::max(rest, 0.0));
    const double s = 2 / (a * a + b * b + c * c + d * d);
    Place place;
    place.affine.directions = {Vec3{1 - s * (c * c + d * d), s * (b * c + a * d), s * (b * d - a * c)},
                               Vec3{s * (b * c - a * d), 1 - s * (b * b + d * d), s * (c * d + a * b)},
                               Vec3{s * (b * d + a * c), s * (c * d - a * b), 1 - s * (b * b + c * c)}};
    place.affine.lengths = sizes;
    place.affine.origin = header.qoffset;
    if (header.pixdim[0] == -1) {
        for (double& component : place.affine.directions[2]) {
            component = -component;
        }
    }
    // The first number is a difference from 1, so its square is uncertain.
    const double error = 3 * epsilon;
    place.doubt = 2 * std::min(std::sqrt(error), error / std::max(a, epsilon));
    return place;
}

/// Neither: x from left to right reversed, and the image's centre (or SPM's voxel) at the origin.
Place unsaidPlace(const NiftiHeader& header, const Vec3& sizes) {
    Place place;
    place.affine.lengths = sizes;
    place.affine.directions = {Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    bool hasOrigin = header.analyzeOrigin != std::array<double, 3>{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto size = static_cast<double>(header.sizes[axis]);
        hasOrigin = hasOrigin && header.analyzeOrigin[axis] > -size && header.analyzeOrigin[axis] < 2 * size;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double centre =
            hasOrigin ? header.analyzeOrigin[axis] - 1 : (static_cast<double>(header.sizes[axis]) - 1) / 2;
        place.affine.origin[axis] = -centre * sizes[axis] * place.affine.directions[axis][axis];
    }
    return place;
}

Result<Grid> gridOf(const fs::path& path, const NiftiHeader& header, AffineSteps affine, double unit) {
    Grid grid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = static_cast<std::uint32_t>(header.sizes[axis]);
        affine.lengths[axis] *= unit;
        affine.origin[axis] *= unit;
    }
    for (std::size_t row = 0; row < 2; ++row) { // RAS to LPS
        affine.origin[row] = -affine.origin[row];
        for (Vec3& direction : affine.directions) {
            direction[row] = -direction[row];
        }
    }
    VOXTACT_TRY(setSteps(grid, affine, path));
    return grid;
}

/// The qform, if the sform is used.
void noteOther(const fs::path& path, const NiftiHeader& header, const Grid& grid, double unit,
               std::vector<std::string>& notes) {
    std::vector<std::string> ignored;
    const Result<Place> place = qformPlace(path, header, voxelSizes(header, ignored));
    const Result<Grid> other = place.ok() ? gridOf(path, header, place->affine, unit) : Result<Grid>(place.error());
    if (!other.ok()) {
        notes.emplace_back("the file's qform is damaged; its sform says where the image is");
        return;
    }
    double extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        extent += grid.size[axis] * std::max(grid.spacing[axis], other->spacing[axis]);
    }
    constexpr double kShare = 0.01;
    constexpr double kSinglePrecision = 1e-6; // of a position far from the origin
    const double farthest = std::hypot(grid.origin[0], grid.origin[1], grid.origin[2]) + extent;
    const double rounding = kShare * *std::min_element(grid.spacing.begin(), grid.spacing.end()) +
                            place->doubt * extent + kSinglePrecision * farthest;
    if (const double apart = cornersApart(grid, *other); apart > rounding) {
        notes.push_back("the file says two places: its sform (code " + std::to_string(header.sformCode) +
                        ") and its qform (code " + std::to_string(header.qformCode) + ") lie up to " + rounded(apart) +
                        " mm apart; the sform is taken");
    }
}

/// Codes that NIfTI does not define are none, as nibabel has it.
std::int32_t definedCode(std::int32_t code, const char* name, std::vector<std::string>& notes) {
    constexpr std::int32_t kLast = 5;
    if (code < 0 || code > kLast) {
        notes.push_back(std::string("the file's ") + name + "_code is " + std::to_string(code) +
                        ", which NIfTI does not define; the " + name + " is not used");
        return 0;
    }
    return code;
}

/// A turn as b, c and d of the unit quaternion with a >= 0: the one of Shepperd's four formulas that divides by most.
/// `columns`: at right angles, right-handed.
std::array<double, 3> quaternionOf(const std::array<Vec3, 3>& columns) {
    const auto& [x, y, z] = columns;
    const std::array<double, 4> squares{1 + x[0] + y[1] + z[2], 1 + x[0] - y[1] - z[2], 1 - x[0] + y[1] - z[2],
                                        1 - x[0] - y[1] + z[2]};
    const std::array<std::array<double, 4>, 4> products{{{squares[0], y[2] - z[1], z[0] - x[2], x[1] - y[0]},
                                                         {y[2] - z[1], squares[1], x[1] + y[0], z[0] + x[2]},
                                                         {z[0] - x[2], x[1] + y[0], squares[2], y[2] + z[1]},
                                                         {x[1] - y[0], z[0] + x[2], y[2] + z[1], squares[3]}}};
    const auto most = static_cast<std::size_t>(std::ranges::max_element(squares) - squares.begin());
    const std::array<double, 4>& row = products[most];
    const double length = std::hypot(std::hypot(row[0], row[1]), std::hypot(row[2], row[3]));
    const double sign = row[0] < 0 ? -1 : 1;
    return {sign * row[1] / length, sign * row[2] / length, sign * row[3] / length};
}

void noteUnsaid(const NiftiHeader& header, std::vector<std::string>& notes) {
    const bool isAnalyze = header.kind == NiftiHeader::Kind::Analyze;
    const bool hasOrigin = header.analyzeOrigin != std::array<double, 3>{};
    notes.push_back(std::string("the file ") +
                    (isAnalyze ? "is Analyze 7.5, which does not say how the patient lies"
                               : "does not say how the patient lies (qform and sform are unset)") +
                    "; its axes are taken as left, anterior, superior, with the origin at " +
                    (hasOrigin ? "SPM's voxel" : "its centre") + ", as nibabel and SPM do");
}

} // namespace

void setNiftiGrid(NiftiHeader& header, const Grid& grid) {
    constexpr std::int32_t kScannerPlace = 1;
    constexpr std::int32_t kMillimetres = 2;
    std::array<Vec3, 3> columns{};
    header.sizes.clear();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        header.sizes.push_back(grid.size[axis]);
        header.pixdim[axis + 1] = grid.spacing[axis];
        for (std::size_t row = 0; row < 3; ++row) {
            const double turn = row < 2 ? -1 : 1; // LPS to RAS
            columns[axis][row] = turn * grid.direction[3 * axis + row];
            header.srow[row][axis] = columns[axis][row] * grid.spacing[axis];
            header.srow[row][3] = turn * grid.origin[row];
        }
    }
    header.units = kMillimetres;
    header.sformCode = kScannerPlace;
    const auto& [x, y, z] = columns;
    const double volume =
        x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) + x[2] * (y[0] * z[1] - y[1] * z[0]);
    header.pixdim[0] = volume < 0 ? -1 : 1;
    if (shearDegrees(grid) > kMaxShear) {
        return;
    }
    header.qformCode = kScannerPlace;
    for (std::size_t row = 0; row < 3; ++row) {
        columns[2][row] *= header.pixdim[0];
        header.qoffset[row] = header.srow[row][3];
    }
    header.quaternion = quaternionOf(columns);
}

Result<Grid> niftiGrid(const fs::path& path, const NiftiHeader& written, std::vector<std::string>& notes) {
    NiftiHeader header = written;
    header.qformCode = definedCode(header.qformCode, "qform", notes);
    header.sformCode = definedCode(header.sformCode, "sform", notes);
    VOXTACT_TRY(checkNumbers(path, header));
    const std::optional<double> unit = millimetresPerUnit(header.units);
    if (!unit) {
        return cannotRead(path, "its unit of length (xyzt_units " + std::to_string(header.units) +
                                    ") is none that NIfTI defines; mend its header");
    }
    Result<Place> place = header.sformCode > 0 ? Result<Place>(sformPlace(header)) : [&]() -> Result<Place> {
        const Vec3 sizes = voxelSizes(header, notes);
        return header.qformCode > 0 ? qformPlace(path, header, sizes) : Result<Place>(unsaidPlace(header, sizes));
    }();
    VOXTACT_TRY(place);
    Result<Grid> grid = gridOf(path, header, place->affine, *unit);
    if (!grid.ok()) {
        return grid;
    }
    if (const double shear = shearDegrees(*grid); shear > kMaxShear) {
        return cannotRead(path, "its sform shears the image by " + rounded(shear) +
                                    " degrees (its axes are not at right angles); resample it to an upright grid");
    }
    if (header.sformCode > 0 && header.qformCode > 0) {
        noteOther(path, header, *grid, *unit, notes);
    }
    if (header.sformCode == 0 && header.qformCode == 0) {
        noteUnsaid(header, notes);
    }
    if (*unit != 1) {
        notes.push_back(std::string("the file's lengths are in ") + (*unit > 1 ? "metres" : "micrometres") +
                        "; they are taken to millimetres");
    }
    return grid;
}

} // namespace voxtact::io
