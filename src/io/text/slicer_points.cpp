// SPDX-License-Identifier: MIT
#include "io/text/slicer_points.h"

#include "core/base/text.h"
#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/json_file.h"
#include "io/text/text_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace voxtact::io {

namespace {

using Json = nlohmann::json;
using NamedPoints = std::vector<NamedPoint>;

/// Points of a file that states its space, as it is stated.
struct StatedPoints {
    NamedPoints points;
    std::optional<MeshSpace> space;
};

/// Both spellings: 4.x writes numbers.
std::optional<MeshSpace> spaceOf(std::string_view word) {
    return word == "LPS" || word == "1"   ? std::optional(MeshSpace::LPS)
           : word == "RAS" || word == "0" ? std::optional(MeshSpace::RAS)
                                          : std::nullopt;
}

const char* nameOf(MeshSpace space) {
    return space == MeshSpace::RAS ? "RAS" : "LPS";
}

/// Returns the fields of a CSV line, without quotes; empty if a quote is not closed.
std::optional<std::vector<std::string>> csvFields(std::string_view line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool isDoubled = quoted && line[i] == '"' && i + 1 < line.size() && line[i + 1] == '"';
        if (isDoubled) {
            fields.back() += '"';
            ++i;
        } else if (line[i] == '"') {
            quoted = !quoted;
        } else if (line[i] == ',' && !quoted) {
            fields.emplace_back();
        } else {
            fields.back() += line[i];
        }
    }
    return quoted ? std::nullopt : std::optional(std::move(fields));
}

/// Columns of a point's fields.
struct Columns {
    std::array<std::size_t, 3> position{1, 2, 3};
    std::size_t label = 11;
};

/// The rest of a line "# NAME = REST".
std::optional<std::string_view> headerValue(std::string_view line, std::string_view name) {
    line = trimmed(line.substr(1));
    if (!line.starts_with(name)) {
        return std::nullopt;
    }
    line = trimmed(line.substr(name.size()));
    return line.starts_with('=') ? std::optional(trimmed(line.substr(1))) : std::nullopt;
}

/// Takes a line that begins with '#'.
Result<void> takeHeader(const std::filesystem::path& path, std::uint64_t number, std::string_view line,
                        Columns& columns, StatedPoints& out) {
    if (const auto space = headerValue(line, "CoordinateSystem")) {
        const std::optional<MeshSpace> stated = spaceOf(*space);
        if (!out.points.empty() || (out.space && out.space != stated)) {
            return badLine(path, number, "the coordinate system is stated behind points, or twice");
        }
        out.space = stated;
        return out.space ? Result<void>()
                         : badLine(path, number, "the coordinate system " + inQuotes(*space) + " is not LPS or RAS");
    }
    if (const auto names = headerValue(line, "columns")) {
        const std::vector<std::string> all = csvFields(*names).value_or(std::vector<std::string>());
        const auto find = [&](const char* name, std::size_t& place) {
            const auto found = std::ranges::find(all, name);
            place = static_cast<std::size_t>(found - all.begin());
            return found != all.end();
        };
        std::array<std::size_t, 3>& at = columns.position;
        if (!find("x", at[0]) || !find("y", at[1]) || !find("z", at[2]) || !find("label", columns.label)) {
            return badLine(path, number, "its columns have no x, y, z and label");
        }
    }
    return {};
}

Result<NamedPoint> pointOf(const std::filesystem::path& path, std::uint64_t number, std::string_view line,
                           const Columns& columns) {
    const std::optional<std::vector<std::string>> fields = csvFields(line);
    if (!fields) {
        return badLine(path, number, "a quote is not closed");
    }
    NamedPoint point;
    point.line = number;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (columns.position[axis] >= fields->size()) {
            return badLine(path, number, "it has " + std::to_string(fields->size()) + " fields, no point has so few");
        }
        if (const auto reason = parseNumber(trimmed((*fields)[columns.position[axis]]), point.position[axis])) {
            return badLine(path, number, *reason);
        }
    }
    point.name = columns.label < fields->size() ? (*fields)[columns.label] : std::string();
    return point;
}

Result<StatedPoints> readFcsv(const std::filesystem::path& path) {
    const Result<std::string> text = readWholeFile(path);
    VOXTACT_TRY(text);
    StatedPoints out;
    Columns columns;
    std::uint64_t number = 0;
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    std::string_view rest = *text;
    rest.remove_prefix(rest.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view line = trimmed(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
        ++number;
        if (line.starts_with('#')) {
            VOXTACT_TRY(takeHeader(path, number, line, columns, out));
        } else if (!line.empty()) {
            Result<NamedPoint> point = pointOf(path, number, line, columns);
            VOXTACT_TRY(point);
            out.points.push_back(std::move(*point));
        }
    }
    return out;
}

/// A member that is a string; empty where it is not there.
std::optional<std::string> stringOf(const Json& object, const char* name) {
    const auto found = object.find(name);
    return found == object.end() ? std::optional(std::string())
           : found->is_string()  ? std::optional(found->get<std::string>())
                                 : std::nullopt;
}

/// The reason why the control point cannot be taken, if any.
std::optional<std::string> takeControlPoint(const Json& item, NamedPoints& points) {
    NamedPoint point;
    point.line = points.size() + 1;
    const std::optional<std::string> status = item.is_object() ? stringOf(item, "positionStatus") : std::nullopt;
    const std::optional<std::string> label = status ? stringOf(item, "label") : std::nullopt;
    if (!label) {
        return "it is not an object with a label and a position";
    }
    if (!status->empty() && *status != "defined") {
        return "its position is " + inQuotes(*status) + ", not defined; place it or delete it";
    }
    const auto position = item.find("position");
    if (position == item.end() || !position->is_array() || position->size() != 3) {
        return "its position is not three numbers";
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Json& number = (*position)[axis];
        if (!number.is_number() || !std::isfinite(number.get<double>())) {
            return "its position is not three finite numbers";
        }
        point.position[axis] = number.get<double>();
    }
    point.name = *label;
    points.push_back(std::move(point));
    return std::nullopt;
}

Result<StatedPoints> takeMarkup(const std::filesystem::path& path, const Json& markup) {
    const std::optional<std::string> type = markup.is_object() ? stringOf(markup, "type") : std::nullopt;
    if (!type || *type != "Fiducial") {
        return cannotRead(path, type ? "its markup is a " + inQuotes(*type) + "; only lists of points are read"
                                     : std::string("a markup is not an object with a type"));
    }
    StatedPoints out;
    const auto space = markup.find("coordinateSystem");
    const std::string word = space == markup.end()        ? "LPS"
                             : space->is_string()         ? space->get<std::string>()
                             : space->is_number_integer() ? space->dump()
                                                          : "";
    out.space = spaceOf(word);
    if (!out.space) {
        return cannotRead(path, "the coordinate system " + inQuotes(word) + " is not LPS or RAS");
    }
    const auto units = markup.find("coordinateUnits");
    const auto isMm = [](const Json& unit) { return unit == "mm"; };
    // An array is a code with its scheme and its meaning.
    if (units != markup.end() && !isMm(*units) && !(units->is_array() && !units->empty() && isMm((*units)[0]))) {
        return cannotRead(path, "its coordinates are not in mm");
    }
    const auto controlPoints = markup.find("controlPoints");
    if (controlPoints == markup.end() || !controlPoints->is_array()) {
        return cannotRead(path, "its markup has no control points");
    }
    for (const Json& item : *controlPoints) {
        if (const auto reason = takeControlPoint(item, out.points)) {
            return cannotRead(path, "control point " + std::to_string(out.points.size() + 1) + ": " + *reason);
        }
    }
    return out;
}

Result<StatedPoints> readMarkups(const std::filesystem::path& path) {
    const Result<Json> root = readJsonFile(path);
    VOXTACT_TRY(root);
    const auto markups = root->is_object() ? root->find("markups") : root->end();
    if (markups == root->end() || !markups->is_array() || markups->size() != 1) {
        return cannotRead(path, "it does not hold one markup");
    }
    return takeMarkup(path, (*markups)[0]);
}

bool endsWith(const std::filesystem::path& path, std::string_view ending) {
    return lowered(path.filename().string()).ends_with(ending);
}

} // namespace

bool isSlicerPoints(const std::filesystem::path& path) {
    return endsWith(path, ".fcsv") || endsWith(path, ".mrk.json");
}

Result<std::vector<NamedPoint>> readSlicerPoints(const std::filesystem::path& path, std::optional<MeshSpace> space) {
    Result<StatedPoints> read = endsWith(path, ".fcsv") ? readFcsv(path) : readMarkups(path);
    VOXTACT_TRY(read);
    if (!space && !read->space) {
        return cannotRead(path, "it does not state its coordinate system; state the space, LPS or RAS");
    }
    if (space && read->space && *space != *read->space) {
        return cannotRead(path, std::string("its coordinates are in ") + nameOf(*read->space) + ", not in " +
                                    nameOf(*space) + " as stated; leave out one of the two");
    }
    for (NamedPoint& point : read->points) {
        for (std::size_t axis = 0; axis < 2 && space.value_or(read->space.value_or(MeshSpace::LPS)) == MeshSpace::RAS;
             ++axis) {
            point.position[axis] = -point.position[axis];
        }
    }
    return std::move(read->points);
}

} // namespace voxtact::io
