// SPDX-License-Identifier: MIT
#include "core/base/guard.h"

#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "voxtact/io.h"

#include <algorithm>
#include <charconv>
#include <span>
#include <unordered_map>

namespace voxtact::io {

namespace {

/// `label` becomes the number that the whole token spells; otherwise the reason is returned.
std::optional<std::string> parseLabel(std::string_view token, std::int32_t& label) {
    double value = 0;
    if (std::optional<std::string> reason = parseNumber(token, value)) {
        return reason;
    }
    const std::string_view digits = token.substr(token.starts_with('+') ? 1 : 0);
    const std::from_chars_result end = std::from_chars(digits.data(), digits.data() + digits.size(), label);
    if (end.ec != std::errc{} || end.ptr != digits.data() + digits.size()) {
        return "'" + std::string(token) + "' is not a whole number that an int32 holds, which a label is";
    }
    return std::nullopt;
}

/// A label and the words behind it.
struct Row {
    std::int32_t label = 0;
    std::uint64_t line = 0;
    std::string name;     ///< without the numbers at the end
    std::string numbered; ///< with the number at the end, if any, which may be a column or part of the name
};

bool isNumber(std::string_view word) {
    double value = 0;
    return !parseNumber(word, value);
}

/// From the first of some words of a line to the last one.
std::string_view textOf(std::span<const std::string_view> words) {
    return words.empty() ? std::string_view()
                         : std::string_view(words.front().data(),
                                            static_cast<std::size_t>(words.back().data() + words.back().size() -
                                                                     words.front().data()));
}

/// `words`: those behind the label. The reason why they are no name.
std::optional<std::string> takeName(std::span<const std::string_view> words, Row& row) {
    if (words.empty()) {
        return "the label " + std::to_string(row.label) + " has no name (number name)";
    }
    // ITK-SNAP: red, green, blue, alpha, two flags, and the name in quotes.
    constexpr std::size_t kSnapNumbers = 6;
    const std::size_t numbers =
        static_cast<std::size_t>(std::find_if_not(words.begin(), words.end(), isNumber) - words.begin());
    const std::string_view text =
        textOf(words.subspan(numbers == kSnapNumbers && numbers < words.size() ? numbers : 0));
    if (text.starts_with('"')) {
        const std::size_t end = text.find('"', 1);
        row.name = row.numbered = text.substr(1, end - 1);
        return end == std::string_view::npos || trimmed(row.name).empty()
                   ? std::optional<std::string>("the name in quotes is empty or does not end")
                   : std::nullopt;
    }
    if (numbers > 0 && words.size() > 1) {
        return "its second word is the number " + inQuotes(words[0]) +
               "; a row is 'number name', or ITK-SNAP's 'number R G B A VIS MSH \"name\"'";
    }
    if (const std::size_t tab = text.find('\t'); tab != std::string_view::npos) {
        row.name = row.numbered = trimmed(text.substr(0, tab));
        return std::nullopt;
    }
    // FreeSurfer's and 3D Slicer's tables have red, green, blue and alpha at the end, MRIcron's one number.
    constexpr std::size_t kColours = 4;
    std::size_t last = words.size();
    while (last > 1 && words.size() - last < kColours && isNumber(words[last - 1])) {
        --last;
    }
    row.name = textOf(words.first(last));
    row.numbered = words.size() - last == 1 ? textOf(words) : std::string_view(row.name);
    return std::nullopt;
}

/// If names without their numbers are equal, the numbers belong to them: "area 4", "area 6".
void tellApart(std::vector<Row>& rows) {
    std::unordered_map<std::string, std::int32_t> labels;
    const bool isSame = std::any_of(rows.begin(), rows.end(), [&](const Row& row) {
        return row.name != row.numbered && labels.try_emplace(row.name, row.label).first->second != row.label;
    });
    for (Row& row : rows) {
        row.name = isSame ? row.numbered : row.name;
    }
}

} // namespace

Result<std::vector<LabelName>> readLabelNames(const std::filesystem::path& path) {
    return guard([&]() -> Result<std::vector<LabelName>> {
        std::vector<Row> rows;
        VOXTACT_TRY(forWords(path, [&](const auto& words, std::uint64_t line) -> Result<void> {
            Row row;
            row.line = line;
            std::optional<std::string> reason = parseLabel(words[0], row.label);
            if (!reason) {
                reason = takeName(std::span(words).subspan(1), row);
            }
            if (reason) {
                return badLine(path, line, *reason);
            }
            rows.push_back(std::move(row));
            return {};
        }));
        if (rows.empty()) {
            return cannotRead(path, "it names no label; a label is a line 'number name'");
        }
        tellApart(rows);
        std::vector<LabelName> names;
        std::unordered_map<std::int32_t, std::size_t> places;
        for (Row& row : rows) {
            const auto [place, fresh] = places.try_emplace(row.label, names.size());
            if (!fresh && names[place->second].name != row.name) {
                return badLine(path, row.line,
                               "the label " + std::to_string(row.label) + " has another name already, '" +
                                   oneLine(names[place->second].name) + "'");
            }
            if (fresh) {
                names.push_back({row.label, std::move(row.name)});
            }
        }
        return names;
    });
}

} // namespace voxtact::io
