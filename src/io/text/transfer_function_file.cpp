// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/json_file.h"
#include "io/text/other_transfer_functions.h"
#include "io/text/text_lines.h"
#include "voxtact/io.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace voxtact::io {

namespace {

using Json = nlohmann::json;
using Points = std::vector<ControlPoint>;

/// The reason why the point cannot follow those before it, if any.
std::optional<std::string> addPoint(Points& points, double value, double opacity) {
    if (!std::isfinite(value)) {
        return "the value is not finite";
    }
    if (!(opacity >= 0 && opacity <= 1)) {
        return "the opacity " + number(opacity) + " is outside 0..1";
    }
    if (!points.empty() && value < points.back().value) {
        return "the value " + number(value) + " is below the one before it (" + number(points.back().value) +
               "); values must ascend";
    }
    points.push_back({value, opacity});
    return std::nullopt;
}

Result<Points> readText(const std::filesystem::path& path) {
    Points points;
    VOXTACT_TRY(forWords(path, [&](const auto& words, std::uint64_t line) -> Result<void> {
        std::array<double, 2> numbers{};
        for (std::size_t i = 0; i < words.size(); ++i) {
            double value = 0;
            if (const auto reason = parseNumber(words[i], value)) {
                return badLine(path, line, *reason);
            }
            numbers[i % 2] = value;
        }
        if (words.size() != 2) {
            return badLine(path, line,
                           std::to_string(words.size()) + (words.size() == 1 ? " number" : " numbers") +
                               ", a point has 2 (value opacity)");
        }
        if (const auto reason = addPoint(points, numbers[0], numbers[1])) {
            return badLine(path, line, *reason);
        }
        return {};
    }));
    if (points.empty()) {
        return cannotRead(path, "it holds no point; a point is a line 'value opacity'");
    }
    return points;
}

/// [value, opacity] or {"value": ..., "opacity": ...}
std::optional<ControlPoint> pointOf(const Json& item) {
    if (item.is_array() && item.size() == 2 && item[0].is_number() && item[1].is_number()) {
        return ControlPoint{item[0].get<double>(), item[1].get<double>()};
    }
    if (item.is_object()) {
        const auto value = item.find("value");
        const auto opacity = item.find("opacity");
        if (value != item.end() && opacity != item.end() && value->is_number() && opacity->is_number()) {
            return ControlPoint{value->get<double>(), opacity->get<double>()};
        }
    }
    return std::nullopt;
}

/// Points of another program.
Result<Points> checkedPoints(const std::filesystem::path& path, const Points& read) {
    Points points;
    for (const ControlPoint& point : read) {
        if (const auto reason = addPoint(points, point.value, point.opacity)) {
            return cannotRead(path, "opacity point " + std::to_string(points.size() + 1) + ": " + *reason);
        }
    }
    return points;
}

bool isVolumeProperty(const std::filesystem::path& path) {
    return lowered(path.extension().string()) == ".vp";
}

Result<Points> readJson(const std::filesystem::path& path) {
    const Result<Json> parsed = readJsonFile(path);
    VOXTACT_TRY(parsed);
    const Json& root = *parsed;
    if (isParaViewMap(root)) {
        const Result<OtherTransferFunction> map = readParaViewMap(path, root);
        VOXTACT_TRY(map);
        return checkedPoints(path, map->opacity);
    }
    const auto list = root.is_object() ? root.find("points") : root.end();
    if (list == root.end() || !list->is_array() || list->empty()) {
        return cannotRead(path, "it has no 'points'; expected {\"points\": [[value, opacity], ...]}");
    }
    Points points;
    for (std::size_t i = 0; i < list->size(); ++i) {
        const auto point = pointOf((*list)[i]);
        const auto reason = point ? addPoint(points, point->value, point->opacity)
                                  : "expected [value, opacity] or {\"value\": ..., \"opacity\": ...}";
        if (reason) {
            return cannotRead(path, "points[" + std::to_string(i) + "]: " + *reason);
        }
    }
    return points;
}

/// Distinguished by the first character.
Result<bool> isJson(const std::filesystem::path& path) {
    Result<LineReader> lines = LineReader::open(path);
    VOXTACT_TRY(lines);
    while (true) {
        const Result<std::optional<std::string_view>> line = lines->next();
        VOXTACT_TRY(line);
        if (!line->has_value()) {
            return false;
        }
        if (!(*line)->empty()) {
            return (*line)->front() == '{' || (*line)->front() == '[';
        }
    }
}

/// The reason why the colour cannot follow those before it, if any.
std::optional<std::string> addColour(std::vector<ColourPoint>& colours, const ColourPoint& point) {
    for (const double channel : point.colour) {
        if (!(channel >= 0 && channel <= 1)) {
            return "the channel " + number(channel) + " is outside 0..1";
        }
    }
    if (!colours.empty() && point.value < colours.back().value) {
        return "the value " + number(point.value) + " is below the one before it (" + number(colours.back().value) +
               "); values must ascend";
    }
    colours.push_back(point);
    return std::nullopt;
}

std::optional<std::string> addColour(std::vector<ColourPoint>& colours, const Json& item) {
    constexpr std::size_t kNumbers = 4;
    if (!item.is_array() || item.size() != kNumbers ||
        !std::all_of(item.begin(), item.end(), [](const Json& number) { return number.is_number(); })) {
        return "expected [value, red, green, blue]";
    }
    return addColour(colours, ColourPoint{item[0].get<double>(),
                                          {item[1].get<double>(), item[2].get<double>(), item[3].get<double>()}});
}

/// Colours of another program.
Result<std::vector<ColourPoint>> checkedColours(const std::filesystem::path& path,
                                                const std::vector<ColourPoint>& read) {
    std::vector<ColourPoint> colours;
    for (const ColourPoint& point : read) {
        if (const auto reason = addColour(colours, point)) {
            return cannotRead(path, "colour point " + std::to_string(colours.size() + 1) + ": " + *reason);
        }
    }
    return colours;
}

} // namespace

Result<std::vector<ControlPoint>> readTransferFunction(const std::filesystem::path& path) {
    return guard([&]() -> Result<Points> {
        if (isVolumeProperty(path)) {
            const Result<OtherTransferFunction> property = readVolumeProperty(path);
            VOXTACT_TRY(property);
            return checkedPoints(path, property->opacity);
        }
        const Result<bool> json = isJson(path);
        VOXTACT_TRY(json);
        Result<Points> points = *json ? readJson(path) : readText(path);
        return points.ok() ? std::move(points)
                           : formatByName(path, points.error(), "write a point as a line 'value opacity'");
    });
}

Result<std::vector<ColourPoint>> readColours(const std::filesystem::path& path) {
    return guard([&]() -> Result<std::vector<ColourPoint>> {
        if (isVolumeProperty(path)) {
            const Result<OtherTransferFunction> property = readVolumeProperty(path);
            VOXTACT_TRY(property);
            return checkedColours(path, property->colours);
        }
        const Result<bool> json = isJson(path);
        VOXTACT_TRY(json);
        std::vector<ColourPoint> colours;
        if (!*json) {
            return colours;
        }
        const Result<Json> root = readJsonFile(path);
        VOXTACT_TRY(root);
        if (isParaViewMap(*root)) {
            const Result<OtherTransferFunction> map = readParaViewMap(path, *root);
            VOXTACT_TRY(map);
            return checkedColours(path, map->colours);
        }
        const auto list = root->is_object() ? root->find("colours") : root->end();
        if (list == root->end()) {
            return colours;
        }
        if (!list->is_array()) {
            return cannotRead(path, "'colours' is not a list of [value, red, green, blue]");
        }
        for (std::size_t i = 0; i < list->size(); ++i) {
            if (const auto reason = addColour(colours, (*list)[i])) {
                return cannotRead(path, "colours[" + std::to_string(i) + "]: " + *reason);
            }
        }
        return colours;
    });
}

Result<std::vector<ControlPoint>> parseOpacity(std::string_view text) {
    return guard([&]() -> Result<Points> {
        const auto refusePoint = [&](std::size_t item, std::string_view reason) {
            return refuse("opacity '" + printable(text) + "': point " + std::to_string(item + 1) + ": " +
                          std::string(reason));
        };
        Points points;
        for (std::size_t begin = 0; begin <= text.size();) {
            const std::size_t end = std::min(text.find(',', begin), text.size());
            const std::string_view item = trimmed(text.substr(begin, end - begin));
            const std::size_t colon = item.find(':');
            if (colon == std::string_view::npos) {
                return refusePoint(points.size(), "expected value:opacity");
            }
            double value = 0;
            double opacity = 0;
            auto reason = parseNumber(trimmed(item.substr(0, colon)), value);
            if (!reason) {
                reason = parseNumber(trimmed(item.substr(colon + 1)), opacity);
            }
            if (!reason) {
                reason = addPoint(points, value, opacity);
            }
            if (reason) {
                return refusePoint(points.size(), *reason);
            }
            begin = end + 1;
        }
        return points;
    });
}

} // namespace voxtact::io
