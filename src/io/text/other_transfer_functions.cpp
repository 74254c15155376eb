// SPDX-License-Identifier: MIT
#include "io/text/other_transfer_functions.h"

#include "core/base/text.h"
#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace voxtact::io {

namespace {

using Json = nlohmann::json;

/// Numbers of a point in ParaView: with opacity, they are value, opacity, midpoint, sharpness; with colour, value, red,
/// green, blue.
constexpr std::size_t kFour = 4;

std::vector<ColourPoint> coloursOf(const std::vector<double>& numbers) {
    std::vector<ColourPoint> colours;
    for (std::size_t i = 0; i + 3 < numbers.size(); i += kFour) {
        colours.push_back({numbers[i], {numbers[i + 1], numbers[i + 2], numbers[i + 3]}});
    }
    return colours;
}

/// The member `name`, a flat list of quadruples; empty where it is not there.
Result<std::vector<double>> quadruplesOf(const std::filesystem::path& path, const Json& map, const char* name) {
    std::vector<double> numbers;
    const auto list = map.find(name);
    if (list == map.end()) {
        return numbers;
    }
    const auto isNumber = [](const Json& item) { return item.is_number(); };
    if (!list->is_array() || list->size() % kFour != 0 || !std::ranges::all_of(*list, isNumber)) {
        return cannotRead(path, std::string(name) + " is not a list of four numbers a point");
    }
    for (const Json& item : *list) {
        numbers.push_back(item.get<double>());
    }
    return numbers;
}

/// Opacity, gradient opacity and colours of a volume property: their numbers behind a count, and their lines.
struct PropertyTexts {
    std::array<std::string, 3> text;
    std::array<std::uint64_t, 3> line{};
};

/// The numbers of a text behind their count, `each` a point.
Result<std::vector<double>> countedNumbers(const std::filesystem::path& path, const PropertyTexts& texts,
                                           std::size_t number, std::size_t each) {
    std::vector<std::string_view> words;
    splitTokens(texts.text[number], words);
    std::vector<double> numbers(words.size());
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (const auto reason = parseNumber(words[i], numbers[i])) {
            return badLine(path, texts.line[number], *reason);
        }
    }
    const std::size_t values = numbers.empty() ? 0 : numbers.size() - 1;
    if (numbers.empty() || numbers.front() != static_cast<double>(values) || values == 0 || values % each != 0) {
        return badLine(path, texts.line[number],
                       "it is not the count of its numbers and " + std::to_string(each) + " numbers a point");
    }
    numbers.erase(numbers.begin());
    return numbers;
}

/// Nine lines: six numbers about interpolation and light, then the three functions.
Result<PropertyTexts> textsOfLines(const std::filesystem::path& path) {
    constexpr int kLook = 6;
    Result<LineReader> lines = LineReader::open(path);
    VOXTACT_TRY(lines);
    for (int i = 0; i < kLook; ++i) {
        const Result<std::optional<std::string_view>> line = lines->next();
        VOXTACT_TRY(line);
        double value = 0;
        if (!line->has_value() || parseNumber(trimmed(**line), value)) {
            return badLine(path, lines->lineNumber(),
                           "it is not one number; the first six lines of 3D Slicer's volume property are");
        }
    }
    PropertyTexts out;
    for (std::size_t i = 0; i < out.text.size(); ++i) {
        const Result<std::optional<std::string_view>> line = lines->next();
        VOXTACT_TRY(line);
        if (!line->has_value()) {
            return cannotRead(path, "it ends before its opacity, gradient opacity and colours");
        }
        out.text[i] = **line;
        out.line[i] = lines->lineNumber();
    }
    for (;;) {
        const Result<std::optional<std::string_view>> line = lines->next();
        VOXTACT_TRY(line);
        if (!line->has_value()) {
            return out;
        }
        if (!trimmed(**line).empty()) {
            return badLine(path, lines->lineNumber(), "it is behind the colours, the last line that is known");
        }
    }
}

/// One XML element whose attributes are the three functions.
Result<PropertyTexts> textsOfXml(const std::filesystem::path& path, std::string_view xml) {
    constexpr std::array<std::string_view, 3> kNames{"scalarOpacity", "gradientOpacity", "colorTransfer"};
    const std::string_view element = xml.substr(0, xml.find('>'));
    PropertyTexts out;
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        const std::string name = std::string(kNames[i]) + "=\"";
        const std::size_t at = element.find(name);
        const std::size_t end = at == std::string_view::npos ? at : element.find('"', at + name.size());
        const bool isOne = end != std::string_view::npos && element.find(name, end) == std::string_view::npos;
        if (!isOne || element[at - 1] > ' ') {
            return cannotRead(path, "its element VolumeProperty has not one attribute " + std::string(kNames[i]));
        }
        out.text[i] = element.substr(at + name.size(), end - at - name.size());
        out.line[i] = 1 + static_cast<std::uint64_t>(
                              std::count(xml.begin(), xml.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    }
    return out;
}

/// Both forms that 3D Slicer writes.
Result<PropertyTexts> propertyTexts(const std::filesystem::path& path) {
    const Result<std::string> text = readWholeFile(path);
    VOXTACT_TRY(text);
    return trimmed(*text).starts_with("<VolumeProperty ") ? textsOfXml(path, *text) : textsOfLines(path);
}

} // namespace

bool isParaViewMap(const Json& root) {
    return root.is_array() && !root.empty() && root[0].is_object() && root[0].contains("RGBPoints");
}

Result<OtherTransferFunction> readParaViewMap(const std::filesystem::path& path, const Json& root) {
    if (root.size() > 1) {
        return cannotRead(path, "it holds " + std::to_string(root.size()) + " colour maps; export one");
    }
    const auto scale = root[0].find("UseLogScale");
    if (scale != root[0].end() && *scale != 0 && *scale != false) {
        return cannotRead(path, "its scale is logarithmic (UseLogScale), which is not supported");
    }
    const Result<std::vector<double>> colours = quadruplesOf(path, root[0], "RGBPoints");
    VOXTACT_TRY(colours);
    const Result<std::vector<double>> points = quadruplesOf(path, root[0], "Points");
    VOXTACT_TRY(points);
    if (points->empty()) {
        return cannotRead(path, "ParaView's colour map has no opacity ('Points'); export it with its opacity");
    }
    OtherTransferFunction out;
    out.colours = coloursOf(*colours);
    for (std::size_t i = 0; i < points->size(); i += kFour) {
        const bool isLast = i + kFour == points->size();
        if (!isLast && ((*points)[i + 2] != 0.5 || (*points)[i + 3] != 0)) {
            return cannotRead(path, "Points[" + std::to_string(i / kFour) +
                                        "]: the opacity behind it has the midpoint " + number((*points)[i + 2]) +
                                        " and the sharpness " + number((*points)[i + 3]) +
                                        "; only 0.5 and 0, linear opacity, are supported");
        }
        out.opacity.push_back({(*points)[i], (*points)[i + 1]});
    }
    return out;
}

Result<OtherTransferFunction> readVolumeProperty(const std::filesystem::path& path) {
    const Result<PropertyTexts> texts = propertyTexts(path);
    VOXTACT_TRY(texts);
    const Result<std::vector<double>> opacity = countedNumbers(path, *texts, 0, 2);
    VOXTACT_TRY(opacity);
    const Result<std::vector<double>> gradient = countedNumbers(path, *texts, 1, 2);
    VOXTACT_TRY(gradient);
    const Result<std::vector<double>> colours = countedNumbers(path, *texts, 2, kFour);
    VOXTACT_TRY(colours);
    for (std::size_t i = 1; i < gradient->size(); i += 2) {
        if ((*gradient)[i] != 1) {
            return badLine(path, texts->line[1],
                           "the gradient opacity " + number((*gradient)[i]) + " is not supported; set it to 1");
        }
    }
    OtherTransferFunction out;
    out.colours = coloursOf(*colours);
    for (std::size_t i = 0; i < opacity->size(); i += 2) {
        out.opacity.push_back({(*opacity)[i], (*opacity)[i + 1]});
    }
    return out;
}

} // namespace voxtact::io
