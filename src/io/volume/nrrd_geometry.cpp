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
#include <limits>
#include <optional>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

Error damaged(const fs::path& path, std::string_view field, std::string_view text) {
    return cannotRead(path, "its NRRD header is damaged ('" + std::string(field) + "' is " + inQuotes(text) + ")");
}

/// A number, or NaN where it is not known: "nan" in any case.
bool parseMaybe(std::string_view token, double& value) {
    const std::string word = lowered(std::string(token));
    if (word == "nan" || word == "-nan") {
        value = std::numeric_limits<double>::quiet_NaN();
        return true;
    }
    return !parseNumber(token, value);
}

/// "(1,0,0)" with blanks anywhere.
std::optional<Vec3> vectorOf(std::string_view text) {
    Vec3 vector{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t end = i < 2 ? text.find(',') : text.size();
        if (end == std::string_view::npos || !parseMaybe(trimmed(text.substr(0, end)), vector[i])) {
            return std::nullopt;
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    const auto unknown = std::count_if(vector.begin(), vector.end(), [](double x) { return std::isnan(x); });
    return unknown == 0 || unknown == 3 ? std::optional(vector) : std::nullopt;
}

/// The unit of the lengths in a file: millimetres by default, the same for all axes in space.
Result<LengthUnit> unitOf(const fs::path& path, const NrrdHeader& header, const NrrdAxes& axes, bool inSpace) {
    const std::string_view field = inSpace ? "spaceunits" : "units";
    const std::string text = header.get(field);
    std::vector<std::string_view> names;
    for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at)) {
        const std::size_t end = text.find('"', at + 1);
        if (end == std::string::npos) {
            return damaged(path, field, text);
        }
        names.push_back(std::string_view(text).substr(at + 1, end - at - 1));
        at = end + 1;
    }
    std::optional<LengthUnit> unit;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t place = inSpace ? axis : axes.places[axis];
        if (place >= names.size()) {
            break;
        }
        const LengthUnit here = lengthUnit(names[place]).value_or(LengthUnit{});
        if (unit && unit->millimetres != here.millimetres) {
            return cannotRead(path, "its axes have different units of length (" + inQuotes(text) + "); write it anew");
        }
        unit = unit && !unit->unknown.empty() ? *unit : here;
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

/// The numbers of a field with one for each axis; NaN where they are not said.
Result<Vec3> perAxis(const fs::path& path, const NrrdHeader& header, std::string_view field, const NrrdAxes& axes) {
    const std::string text = header.get(field);
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    Vec3 numbers{kUnknown, kUnknown, kUnknown};
    std::vector<std::string_view> tokens;
    splitTokens(text, tokens);
    for (std::size_t axis = 0; axis < 3 && !text.empty(); ++axis) {
        if (tokens.size() != axes.sizes.size() || !parseMaybe(tokens[axes.places[axis]], numbers[axis])) {
            return damaged(path, field, text);
        }
    }
    return numbers;
}

bool isKnown(const Vec3& numbers) {
    return std::none_of(numbers.begin(), numbers.end(), [](double x) { return std::isnan(x); });
}

/// With a space: a vector for each axis, and the centre of the first voxel. mm.
Result<AffineSteps> spaceSteps(const fs::path& path, const NrrdHeader& header, const NrrdAxes& axes, double unit,
                               std::vector<std::string>& notes) {
    AffineSteps affine;
    affine.directions = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    const Result<Vec3> spacings = perAxis(path, header, "spacings", axes);
    VOXTACT_TRY(spacings);
    if (std::any_of(spacings->begin(), spacings->end(), [](double x) { return !std::isnan(x); })) {
        return cannotRead(path,
                          "its NRRD header says 'spacings' together with a space, which NRRD forbids; write it anew");
    }
    if (const std::string text = header.get("spacedirections"); !text.empty()) {
        const auto vectors = nrrdVectors(text);
        if (!vectors || vectors->size() != axes.sizes.size()) {
            return damaged(path, "space directions", text);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::optional<Vec3>& vector = (*vectors)[axes.places[axis]];
            if (!vector) {
                return cannotRead(path, "its voxels are not single numbers (axis " + std::to_string(axes.places[axis]) +
                                            " has no direction in space); convert it to integers or floats");
            }
            affine.directions[axis] = *vector;
            affine.lengths[axis] = unit;
        }
    } else {
        notes.emplace_back(kNoSpacing);
    }
    const std::string text = header.get("spaceorigin");
    const auto origin = nrrdVectors(text);
    if (!origin || origin->size() > 1) {
        return damaged(path, "space origin", text);
    }
    if (origin->empty() || !origin->front()) {
        notes.emplace_back(kNoOrigin);
        return affine;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        affine.origin[axis] = (*origin->front())[axis] * unit;
    }
    return affine;
}

/// For each axis: true if it begins and ends at voxel centres ("node"), false if at voxel borders.
struct Centerings {
    std::array<bool, 3> node{};
    bool isSaid = true; ///< else a border is taken
};

Centerings centeringsOf(const NrrdHeader& header, const NrrdAxes& axes) {
    std::vector<std::string_view> centres;
    const std::string text = header.get(header.get("centers").empty() ? "centerings" : "centers");
    splitTokens(text, centres);
    Centerings found;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t place = axes.places[axis];
        const std::string_view centre = place < centres.size() ? centres[place] : std::string_view();
        found.node[axis] = centre == "node";
        found.isSaid = found.isSaid && (centre == "node" || centre == "cell");
    }
    return found;
}

/// The distances between voxels, from one end of each axis to the other; NaN where that says none.
Vec3 lengthsBetween(const Vec3& mins, const Vec3& maxs, const NrrdAxes& axes, const Centerings& centerings) {
    Vec3 lengths{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto steps = static_cast<double>(axes.sizes[axis] - (centerings.node[axis] ? 1 : 0));
        lengths[axis] = (maxs[axis] - mins[axis]) / steps;
        if (!(lengths[axis] > 0) || !std::isfinite(lengths[axis])) {
            lengths[axis] = std::numeric_limits<double>::quiet_NaN();
        }
    }
    return lengths;
}

/// `ofAxes`: by where the axes begin and end.
Vec3 lengthsOf(const Vec3& spacings, const Vec3& ofAxes, double unit, std::vector<std::string>& notes) {
    constexpr double kRounding = 1e-4; // of what is written
    Vec3 lengths{};
    bool differs = false;
    bool taken = false;
    std::string unsaid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool isSaid = !std::isnan(spacings[axis]);
        differs = differs || std::abs(spacings[axis] - ofAxes[axis]) > kRounding * std::abs(spacings[axis]);
        taken = taken || (!isSaid && !std::isnan(ofAxes[axis]));
        lengths[axis] = (isSaid ? spacings[axis] : ofAxes[axis]) * unit;
        if (std::isnan(lengths[axis])) {
            lengths[axis] = 1;
            unsaid += (unsaid.empty() ? "" : " and ") + std::to_string(axis);
        }
    }
    if (differs) {
        notes.emplace_back("the file's 'axis mins' and 'axis maxs' do not fit its 'spacings'; these are taken");
    }
    if (taken) {
        notes.emplace_back("the file does not say its spacing; what 'axis mins' and 'axis maxs' say of it is taken");
    }
    if (unsaid.find("and") != unsaid.rfind("and")) {
        notes.emplace_back(kNoSpacing);
    } else if (!unsaid.empty()) {
        notes.push_back("the file does not say its spacing along axis " + unsaid + "; 1 mm is taken");
    }
    return lengths;
}

/// Without one: a distance for each axis, and where the first voxel begins or has its centre, and where the last one
/// ends. mm.
Result<AffineSteps> plainSteps(const fs::path& path, const NrrdHeader& header, const NrrdAxes& axes, double unit,
                               std::vector<std::string>& notes) {
    AffineSteps affine;
    affine.directions = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    const Result<Vec3> spacings = perAxis(path, header, "spacings", axes);
    VOXTACT_TRY(spacings);
    const Result<Vec3> mins = perAxis(path, header, "axismins", axes);
    VOXTACT_TRY(mins);
    const Result<Vec3> maxs = perAxis(path, header, "axismaxs", axes);
    VOXTACT_TRY(maxs);
    const Centerings centerings = centeringsOf(header, axes);
    affine.lengths = lengthsOf(*spacings, lengthsBetween(*mins, *maxs, axes, centerings), unit, notes);
    if (!isKnown(*mins)) {
        notes.emplace_back(kNoOrigin);
        return affine;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        affine.origin[axis] = (*mins)[axis] * unit + (centerings.node[axis] ? 0 : affine.lengths[axis] / 2);
    }
    if (!centerings.isSaid) {
        notes.emplace_back(
            "the file does not say of each axis whether 'axis mins' is a border or a centre of its first "
            "voxel ('centerings'); a border is taken, as ITK does");
    }
    return affine;
}

} // namespace

std::optional<std::vector<std::optional<Vec3>>> nrrdVectors(std::string_view text) {
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
        vectors.push_back(isKnown(*vector) ? vector : std::nullopt);
        text.remove_prefix(end + 1);
    }
    return vectors;
}

Result<Grid> nrrdGrid(const fs::path& path, const NrrdHeader& header, const NrrdAxes& axes,
                      std::vector<std::string>& notes) {
    const std::string space = withoutBlanks(header.get("space"));
    VOXTACT_TRY(checkSpaceDimensions(path, space, header));
    const std::optional<Vec3> signs = signsOf(space);
    if (!signs) {
        notes.emplace_back("the file does not say how the patient lies (its 'space' is not an anatomical one); its "
                           "axes are taken as left, posterior, superior");
    }
    const bool inSpace = !space.empty() || !header.get("spacedimension").empty();
    const Result<LengthUnit> unit = unitOf(path, header, axes, inSpace);
    VOXTACT_TRY(unit);
    Result<AffineSteps> affine = inSpace ? spaceSteps(path, header, axes, unit->millimetres, notes)
                                         : plainSteps(path, header, axes, unit->millimetres, notes);
    VOXTACT_TRY(affine);
    Grid grid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = static_cast<std::uint32_t>(axes.sizes[axis]);
        const double sign = signs ? (*signs)[axis] : 1;
        affine->origin[axis] *= sign;
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
