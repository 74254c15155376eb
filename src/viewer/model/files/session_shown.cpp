// SPDX-License-Identifier: MIT
#include "viewer/model/files/session_shown.h"

#include <algorithm>
#include <cmath>

namespace voxtact::view {

namespace {

using Json = SessionReader::Json;

constexpr std::array<const char*, 3> kHandleAxes{"world", "view", "own"};
constexpr std::array<const char*, 5> kPanes{"none", "picture", "slice 1", "slice 2", "slice 3"};
constexpr std::array<const char*, 2> kThemes{"dark", "light"};

/// The number of a word among those that may stand there.
template <std::size_t N>
std::size_t readWord(SessionReader& reader, const std::string& path, const std::array<const char*, N>& words) {
    const std::string word = reader.text(path, words.front());
    const auto* const found = std::ranges::find(words, word);
    if (found == words.end()) {
        reader.refuse(path, "is not an allowed word");
        return 0;
    }
    return static_cast<std::size_t>(found - words.begin());
}

bool readSwitch(SessionReader& reader, const std::string& path, bool standard) {
    const Json* json = reader.find(path);
    if (json != nullptr && !json->is_boolean()) {
        reader.refuse(path, "is neither true nor false");
    }
    return json == nullptr || !json->is_boolean() ? standard : json->get<bool>();
}

double readPositive(SessionReader& reader, const std::string& path, double standard) {
    const double number = reader.number(path, standard);
    if (!(number > 0) || !std::isfinite(number)) {
        reader.refuse(path, "is not a positive number");
    }
    return number;
}

} // namespace

void readHoles(SessionReader& reader, Document& document) {
    reader.each("holes", [&](const std::string& at, const Json& json) {
        const auto [x, y, z, radius] = reader.numbers<4>(at, json);
        if (!(radius >= 0)) {
            reader.refuse(at, "its last number, the radius, is below 0");
        }
        document.holes.push_back({{x, y, z}, radius});
    });
    document.edit.holes = document.holes.size();
}

void readShown(SessionReader& reader, Document& document) {
    if (reader.find("shown") == nullptr) {
        return;
    }
    Shown shown;
    shown.handleAxes = static_cast<GizmoAxes>(readWord(reader, "shown.handle_axes", kHandleAxes));
    shown.maximised = static_cast<Maximised>(readWord(reader, "shown.maximised", kPanes));
    shown.theme = static_cast<Theme>(readWord(reader, "shown.theme", kThemes));
    shown.handles = readSwitch(reader, "shown.handles", shown.handles);
    shown.contacts = readSwitch(reader, "shown.contacts", shown.contacts);
    shown.logHistogram = readSwitch(reader, "shown.log_histogram", shown.logHistogram);
    shown.stepMillimetres = readPositive(reader, "shown.step_mm", shown.stepMillimetres);
    shown.stepDegrees = readPositive(reader, "shown.step_degrees", shown.stepDegrees);
    shown.drillRadius = readPositive(reader, "shown.drill_radius_mm", shown.drillRadius);
    if (const Json* json = reader.find("shown.window"); json != nullptr) {
        const auto [lo, hi] = reader.numbers<2>("shown.window", *json);
        if (!(lo < hi)) {
            reader.refuse("shown.window", "is not two ascending numbers");
        }
        shown.window = ValueRange{lo, hi};
    }
    document.shown = shown;
}

void writeShown(Json& json, const Document& document) {
    for (std::size_t i = 0; i < std::min(document.edit.holes, document.holes.size()); ++i) {
        const Ball& hole = document.holes[i];
        json["holes"].push_back({hole.centre[0], hole.centre[1], hole.centre[2], hole.radius});
    }
    if (!document.shown) {
        return;
    }
    const Shown& shown = *document.shown;
    Json& to = json["shown"];
    to["handle_axes"] = kHandleAxes[static_cast<std::size_t>(shown.handleAxes)];
    to["maximised"] = kPanes[static_cast<std::size_t>(shown.maximised)];
    to["theme"] = kThemes[static_cast<std::size_t>(shown.theme)];
    to["handles"] = shown.handles;
    to["contacts"] = shown.contacts;
    to["log_histogram"] = shown.logHistogram;
    to["step_mm"] = shown.stepMillimetres;
    to["step_degrees"] = shown.stepDegrees;
    to["drill_radius_mm"] = shown.drillRadius;
    if (shown.window) {
        to["window"] = {shown.window->lo, shown.window->hi};
    }
}

} // namespace voxtact::view
