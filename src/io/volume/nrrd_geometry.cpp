// SPDX-License-Identifier: MIT
#include "core/base/text.h"

#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "io/volume/nrrd_header.h"
#include "io/volume/volume_container.h"

#include <algorithm>
#include <array>
#include <optional>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

Error damaged(const fs::path& path, std::string_view field, std::string_view text) {
    return cannotRead(path, "its NRRD header is damaged ('" + std::string(field) + "' is " + inQuotes(text) + ")");
}

/// "(1,0,0)" with blanks anywhere.
std::optional<Vec3> vectorOf(std::string_view text) {
    Vec3 vector{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t end = i < 2 ? text.find(',') : text.size();
        if (end == std::string_view::npos || parseNumber(trimmed(text.substr(0, end)), vector[i])) {
            return std::nullopt;
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return vector;
}

/// A list of vectors in brackets; one that is "none" is left out of it, and stands for an axis that is not in space.
std::optional<std::vector<std::optional<Vec3>>> vectorsOf(std::string_view text) {
    std::vector<std::optional<Vec3>> vectors;
    for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
        if (text.starts_with("none")) {
            vectors.emplace_back(std::nullopt);
            text.remove_prefix(4);
            continue;
        }
        const std::size_t end = text.find(')');
        const std::optional<Vec3> vector =
            text.starts_with('(') && end != std::string_view::npos ? vectorOf(text.substr(1, end - 1)) : std::nullopt;
        if (!vector) {
            return std::nullopt;
        }
        vectors.emplace_back(vector);
        text.remove_prefix(end + 1);
    }
    return vectors;
}

/// What a length in a file is in millimetres; 1 where the file does not say its unit. All axes in space have one.
Result<double> millimetresPerUnit(const fs::path& path, const NrrdHeader& header, bool inSpace) {
    const std::string_view field = inSpace ? "spaceunits" : "units";
    const std::string text = header.get(field);
    std::optional<double> unit;
    std::size_t axis = 0;
    for (std::size_t at = text.find('"'); at != std::string::npos && axis < 3; at = text.find('"', at), ++axis) {
        const std::size_t end = text.find('"', at + 1);
        if (end == std::string::npos) {
            return damaged(path, field, text);
        }
        const std::string name = text.substr(at + 1, end - at - 1);
        const double here = name == "m"                                               ? 1e3
                            : name == "cm"                                            ? 10
                            : name == "um" || name == "\xC2\xB5m" || name == "micron" ? 1e-3
                                                                                      : 1;
        if (unit && *unit != here) {
            return cannotRead(path, "its axes have different units of length (" + inQuotes(text) + "); write it anew");
        }
        unit = here;
        at = end + 1;
    }
    return unit.value_or(1);
}

/// The signs that take a space to LPS; none where the space is not an anatomical one.
std::optional<Vec3> signsOf(const std::string& space) {
    struct Known {
        std::string_view name;
        std::string_view letters;
        Vec3 signs;
    };
    constexpr std::array<Known, 3> kSpaces{{{"left-posterior-superior", "lps", {1, 1, 1}},
                                            {"right-anterior-superior", "ras", {-1, -1, 1}},
                                            {"left-anterior-superior", "las", {1, -1, 1}}}};
    for (const Known& known : kSpaces) {
        if (space == known.name || space == known.letters) {
            return known.signs;
        }
    }
    return std::nullopt;
}

/// The numbers of a field with one for each axis; none where it is not there. An axis that has none says "nan".
Result<std::optional<Vec3>> perAxis(const fs::path& path, const NrrdHeader& header, std::string_view field,
                                    std::size_t axes) {
    const std::string text = header.get(field);
    std::optional<Vec3> numbers;
    if (text.empty()) {
        return numbers;
    }
    std::vector<std::string_view> tokens;
    splitTokens(text, tokens);
    numbers.emplace();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (tokens.size() != axes || parseNumber(tokens[axis], (*numbers)[axis])) {
            return damaged(path, field, text);
        }
    }
    return numbers;
}

/// With a space: a vector for each axis, and the centre of the first voxel.
Result<AffineSteps> spaceSteps(const fs::path& path, const NrrdHeader& header, std::size_t axes,
                               std::vector<std::string>& notes) {
    AffineSteps affine;
    affine.directions = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    if (!header.get("spacings").empty()) {
        return cannotRead(path, "its NRRD header says 'spacings' beside a space, which NRRD forbids; write it anew");
    }
    if (const std::string text = header.get("spacedirections"); !text.empty()) {
        const auto vectors = vectorsOf(text);
        if (!vectors || vectors->size() != axes) {
            return damaged(path, "space directions", text);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!(*vectors)[axis]) {
                return cannotRead(path, "its voxels are not single numbers (axis " + std::to_string(axis) +
                                            " has no direction in space); convert it to integers or floats");
            }
            affine.directions[axis] = *(*vectors)[axis];
        }
    } else {
        notes.emplace_back(kNoSpacing);
    }
    if (const std::string text = header.get("spaceorigin"); !text.empty()) {
        const auto origin = vectorsOf(text);
        if (!origin || origin->size() != 1 || !origin->front()) {
            return damaged(path, "space origin", text);
        }
        affine.origin = *origin->front();
    } else {
        notes.emplace_back(kNoOrigin);
    }
    return affine;
}

/// The centre of the first voxel where the axes begin at `mins`: its border, or with the centering "node" its centre.
Vec3 firstVoxel(const NrrdHeader& header, const Vec3& mins, const Vec3& lengths, std::vector<std::string>& notes) {
    std::vector<std::string_view> centres;
    const std::string text = header.get(header.get("centers").empty() ? "centerings" : "centers");
    splitTokens(text, centres);
    Vec3 first{};
    bool isSaid = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string_view centre = axis < centres.size() ? centres[axis] : std::string_view();
        isSaid = isSaid && (centre == "node" || centre == "cell");
        first[axis] = mins[axis] + (centre == "node" ? 0 : lengths[axis] / 2);
    }
    if (!isSaid) {
        notes.emplace_back(
            "the file does not say of each axis whether 'axis mins' is a border or a centre of its first "
            "voxel ('centerings'); a border is taken, as ITK does");
    }
    return first;
}

/// Without one: a distance for each axis, and where the first voxel begins or has its centre.
Result<AffineSteps> plainSteps(const fs::path& path, const NrrdHeader& header, const std::vector<std::int64_t>& sizes,
                               std::vector<std::string>& notes) {
    AffineSteps affine;
    affine.directions = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    const Result<std::optional<Vec3>> spacings = perAxis(path, header, "spacings", sizes.size());
    const Result<std::optional<Vec3>> mins = perAxis(path, header, "axismins", sizes.size());
    if (!spacings.ok() || !mins.ok()) {
        return spacings.ok() ? mins.error() : spacings.error();
    }
    if (*spacings) {
        affine.lengths = **spacings;
    } else {
        notes.emplace_back(kNoSpacing);
    }
    if (*mins) {
        affine.origin = firstVoxel(header, **mins, affine.lengths, notes);
    } else {
        notes.emplace_back(kNoOrigin);
    }
    return affine;
}

} // namespace

Result<Grid> nrrdGrid(const fs::path& path, const NrrdHeader& header, const std::vector<std::int64_t>& sizes,
                      std::vector<std::string>& notes) {
    const std::string space = withoutBlanks(header.get("space"));
    const std::optional<Vec3> signs = signsOf(space);
    if (!signs) {
        notes.emplace_back("the file does not say how the patient lies (its 'space' is not an anatomical one); its "
                           "axes are taken as left, posterior, superior");
    }
    const bool inSpace = !space.empty() || !header.get("spacedimension").empty();
    const Result<double> unit = millimetresPerUnit(path, header, inSpace);
    Result<AffineSteps> affine = !unit.ok() ? Result<AffineSteps>(unit.error())
                                 : inSpace  ? spaceSteps(path, header, sizes.size(), notes)
                                            : plainSteps(path, header, sizes, notes);
    VOXTACT_TRY(affine);
    Grid grid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = static_cast<std::uint32_t>(sizes[axis]);
        affine->lengths[axis] *= *unit;
        const double sign = signs ? (*signs)[axis] : 1;
        affine->origin[axis] *= *unit * sign;
        for (Vec3& direction : affine->directions) {
            direction[axis] *= sign;
        }
    }
    VOXTACT_TRY(setSteps(grid, *affine, path));
    noteShear(grid, notes);
    if (*unit != 1) {
        notes.push_back("the file's unit of length is " + number(*unit) + " mm; its lengths are taken to millimetres");
    }
    return grid;
}

} // namespace voxtact::io
