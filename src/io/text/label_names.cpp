// SPDX-License-Identifier: MIT
#include "core/base/guard.h"

#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "voxtact/io.h"

#include <charconv>
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

} // namespace

Result<std::vector<LabelName>> readLabelNames(const std::filesystem::path& path) {
    return guard([&]() -> Result<std::vector<LabelName>> {
        std::vector<LabelName> names;
        std::unordered_map<std::int32_t, std::size_t> places;
        VOXTACT_TRY(forWords(path, [&](const auto& words, std::uint64_t line) -> Result<void> {
            LabelName entry;
            if (const auto reason = parseLabel(words[0], entry.label)) {
                return badLine(path, line, *reason);
            }
            if (words.size() < 2) {
                return badLine(path, line, "the label " + std::to_string(entry.label) + " has no name (number name)");
            }
            entry.name = words[1];
            const auto [place, fresh] = places.try_emplace(entry.label, names.size());
            if (!fresh && names[place->second].name != entry.name) {
                return badLine(path, line,
                               "the label " + std::to_string(entry.label) + " has another name already, '" +
                                   oneLine(names[place->second].name) + "'");
            }
            if (fresh) {
                names.push_back(std::move(entry));
            }
            return {};
        }));
        if (names.empty()) {
            return cannotRead(path, "it names no label; a label is a line 'number name'");
        }
        return names;
    });
}

} // namespace voxtact::io
