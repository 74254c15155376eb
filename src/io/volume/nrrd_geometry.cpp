// SPDX-License-Identifier: MIT
#include "core/base/text.h"

#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "io/volume/length_unit.h"
#include "io/volume/nrrd_header.h"
#include "io/volume/volume_container.h"

#include <algorithm>
#include <array>
#include <cmath>
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

/// Of the lengths in a file: millimetres where it does not say it. All axes in space have one.
Result<LengthUnit> unitOf(const fs::path& path, const NrrdHeader& header, bool inSpace) {
    const std::string_view field = inSpace ? "spaceunits" : "units";
    const std::string text = header.get(field);
    std::optional<LengthUnit> unit;
    std::size_t axis = 0;
    for (std::size_t at = text.find('"'); at != std::string::npos && axis < 3; at = text.find('"', at), ++axis) {
        const std::size_t end = text.find('"', at + 1);
        if (end == std::string::npos) {
            return damaged(path, field, text);
        }
        const LengthUnit here = lengthUnit(std::string_view(text).substr(at + 1, end - at - 1)).value_or(LengthUnit{});
        if (unit && unit->millimetres != here.millimetres) {
            return cannotRead(path, "its axes have different units of length (" + inQuotes(text) + "); write it anew");
        }
        unit = unit && !unit->unknown.empty() ? *unit : here;
        at = end + 1;
    }
    return unit.value_or(LengthUnit{});
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

/// Refuses a space that has time as well, or another number of dimensions.
Result<void> checkSpaceDimensions(const fs::path& path, const std::string& space, const NrrdHeader& header) {
    constexpr std::array<std::string_view, 3> kWithTime{"rast", "last", "lpst"};
    const std::string dimension = header.get("spacedimension");
    const bool hasTime =
        space.ends_with("-time") || std::find(kWithTime.begin(), kWithTime.end(), space) != kWithTime.end();
    if (hasTime || (!dimension.empty() && trimmed(dimension) != "3")) {
        return cannotRead(path, "its space has " + (hasTime ? std::string("time, too") : dimension + " dimensions") +
                                    "; write it anew in one that has 3 dimensions");
    }
    return {};
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
        return cannotRead(path,
                          "its NRRD header says 'spacings' together with a space, which NRRD forbids; write it anew");
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

/// Of each axis whether it begins and ends with the centre of a voxel ("node"), or with a border of it.
struct Centerings {
    std::array<bool, 3> node{};
    bool isSaid = true; ///< else a border is taken
};

Centerings centeringsOf(const NrrdHeader& header) {
    std::vector<std::string_view> centres;
    const std::string text = header.get(header.get("centers").empty() ? "centerings" : "centers");
    splitTokens(text, centres);
    Centerings found;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string_view centre = axis < centres.size() ? centres[axis] : std::string_view();
        found.node[axis] = centre == "node";
        found.isSaid = found.isSaid && (centre == "node" || centre == "cell");
    }
    return found;
}

/// The distances between voxels, from one end of each axis to the other.
std::optional<Vec3> lengthsBetween(const Vec3& mins, const Vec3& maxs, const std::vector<std::int64_t>& sizes,
                                   const Centerings& centerings) {
    Vec3 lengths{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lengths[axis] = (maxs[axis] - mins[axis]) / static_cast<double>(sizes[axis] - (centerings.node[axis] ? 1 : 0));
        if (!(lengths[axis] > 0) || !std::isfinite(lengths[axis])) {
            return std::nullopt;
        }
    }
    return lengths;
}

bool isNearly(const Vec3& a, const Vec3& b) {
    constexpr double kRounding = 1e-4; // of what is written
    bool nearly = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        nearly = nearly && std::abs(a[axis] - b[axis]) <= kRounding * std::abs(a[axis]);
    }
    return nearly;
}

/// `ofAxes`: by where the axes begin and end, if they say it.
Vec3 lengthsOf(const std::optional<Vec3>& spacings, const std::optional<Vec3>& ofAxes,
               std::vector<std::string>& notes) {
    if (spacings) {
        if (ofAxes && !isNearly(*spacings, *ofAxes)) {
            notes.emplace_back("the file's 'axis mins' and 'axis maxs' do not fit its 'spacings'; these are taken");
        }
        return *spacings;
    }
    if (ofAxes) {
        notes.emplace_back("the file does not say its spacing; what 'axis mins' and 'axis maxs' say of it is taken");
        return *ofAxes;
    }
    notes.emplace_back(kNoSpacing);
    return {1, 1, 1};
}

/// Without one: a distance for each axis, and where the first voxel begins or has its centre, and where the last one
/// ends.
Result<AffineSteps> plainSteps(const fs::path& path, const NrrdHeader& header, const std::vector<std::int64_t>& sizes,
                               std::vector<std::string>& notes) {
    AffineSteps affine;
    affine.directions = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    const Result<std::optional<Vec3>> spacings = perAxis(path, header, "spacings", sizes.size());
    VOXTACT_TRY(spacings);
    const Result<std::optional<Vec3>> mins = perAxis(path, header, "axismins", sizes.size());
    VOXTACT_TRY(mins);
    const Result<std::optional<Vec3>> maxs = perAxis(path, header, "axismaxs", sizes.size());
    VOXTACT_TRY(maxs);
    const Centerings centerings = centeringsOf(header);
    affine.lengths =
        lengthsOf(*spacings, *mins && *maxs ? lengthsBetween(**mins, **maxs, sizes, centerings) : std::nullopt, notes);
    if (!*mins) {
        notes.emplace_back(kNoOrigin);
        return affine;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        affine.origin[axis] = (**mins)[axis] + (centerings.node[axis] ? 0 : affine.lengths[axis] / 2);
    }
    if (!centerings.isSaid) {
        notes.emplace_back(
            "the file does not say of each axis whether 'axis mins' is a border or a centre of its first "
            "voxel ('centerings'); a border is taken, as ITK does");
    }
    return affine;
}

} // namespace

Result<Grid> nrrdGrid(const fs::path& path, const NrrdHeader& header, const std::vector<std::int64_t>& sizes,
                      std::vector<std::string>& notes) {
    const std::string space = withoutBlanks(header.get("space"));
    VOXTACT_TRY(checkSpaceDimensions(path, space, header));
    const std::optional<Vec3> signs = signsOf(space);
    if (!signs) {
        notes.emplace_back("the file does not say how the patient lies (its 'space' is not an anatomical one); its "
                           "axes are taken as left, posterior, superior");
    }
    const bool inSpace = !space.empty() || !header.get("spacedimension").empty();
    const Result<LengthUnit> unit = unitOf(path, header, inSpace);
    Result<AffineSteps> affine = !unit.ok() ? Result<AffineSteps>(unit.error())
                                 : inSpace  ? spaceSteps(path, header, sizes.size(), notes)
                                            : plainSteps(path, header, sizes, notes);
    VOXTACT_TRY(affine);
    Grid grid;
    // What is taken where nothing is said is in millimetres.
    const bool isSaid = std::find(notes.begin(), notes.end(), kNoSpacing) == notes.end();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = static_cast<std::uint32_t>(sizes[axis]);
        affine->lengths[axis] *= isSaid ? unit->millimetres : 1;
        const double sign = signs ? (*signs)[axis] : 1;
        affine->origin[axis] *= unit->millimetres * sign;
        for (Vec3& direction : affine->directions) {
            direction[axis] *= sign;
        }
    }
    VOXTACT_TRY(setSteps(grid, *affine, path));
    noteShear(grid, notes);
    noteUnit(*unit, notes);
    return grid;
}

} // namespace voxtact::io
