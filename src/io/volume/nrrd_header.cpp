// SPDX-License-Identifier: MIT
#include "io/volume/nrrd_header.h"

#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"

#include <charconv>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

std::optional<std::int64_t> wholeNumber(std::string_view token) {
    std::int64_t value = 0;
    const auto end = std::from_chars(token.data(), token.data() + token.size(), value);
    return end.ec == std::errc{} && end.ptr == token.data() + token.size() ? std::optional(value) : std::nullopt;
}

/// NRRD forbids a field to be there twice; one that says the same is let pass.
Result<void> addField(const fs::path& path, std::string_view name, std::string_view value, NrrdHeader& header) {
    const auto [field, isNew] = header.fields.try_emplace(withoutBlanks(name), value);
    if (!isNew && field->second != value) {
        return cannotRead(path, "its NRRD header is damaged: it says " + inQuotes(name) + " twice, first " +
                                    inQuotes(field->second) + " and then " + inQuotes(value));
    }
    return {};
}

} // namespace

std::optional<std::int64_t> NrrdHeader::integer(std::string_view key) const {
    const auto found = fields.find(key);
    return found == fields.end() ? std::optional<std::int64_t>(0) : wholeNumber(found->second);
}

std::string withoutBlanks(std::string_view key) {
    std::string text;
    for (const char c : key) {
        if (c != ' ') {
            text += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        }
    }
    return text;
}

Result<NrrdHeader> readNrrdHeader(ByteReader& reader) {
    constexpr std::size_t kLongest = 1 << 22;
    std::size_t length = 0;
    NrrdHeader header;
    for (bool first = true; !header.complete && length < kLongest; first = false) {
        const Result<std::optional<std::string>> read = reader.line(kLongest - length);
        VOXTACT_TRY(read);
        const std::optional<std::string>& line = *read;
        if (first && (!line || !line->starts_with("NRRD000"))) {
            return cannotRead(reader.path(), "it is not a NRRD file (it does not begin with NRRD000)");
        }
        if (!line) {
            break;
        }
        length += line->size() + 1;
        const std::string_view text = trimmed(*line);
        header.complete = text.empty() && reader.lineEnded();
        const std::size_t colon = text.find(": ");
        // "key:=value" is a note of somebody's.
        if (colon != std::string_view::npos && colon < text.find(":=") && !text.starts_with('#')) {
            VOXTACT_TRY(addField(reader.path(), text.substr(0, colon), trimmed(text.substr(colon + 1)), header));
        }
    }
    for (const char* needed : {"type", "dimension", "sizes", "encoding"}) {
        if (header.get(needed).empty()) {
            return cannotRead(reader.path(),
                              std::string("it is truncated or damaged: its NRRD header has no '") + needed + "'");
        }
    }
    return header;
}

Result<std::vector<std::int64_t>> nrrdSizes(const fs::path& path, const NrrdHeader& header) {
    std::vector<std::string_view> tokens;
    const std::string text = header.get("sizes");
    splitTokens(text, tokens);
    std::vector<std::int64_t> sizes;
    for (const std::string_view token : tokens) {
        const std::optional<std::int64_t> size = wholeNumber(token);
        if (!size) {
            return cannotRead(path, "its NRRD header is damaged ('sizes' is " + inQuotes(text) + ")");
        }
        sizes.push_back(*size);
    }
    if (header.get("dimension") != std::to_string(sizes.size())) {
        return cannotRead(path, "its NRRD header is damaged: 'sizes' does not have 'dimension' numbers");
    }
    // A "domain" axis is one in space; others hold components.
    std::vector<std::string_view> kinds;
    const std::string kindText = header.get("kinds");
    splitTokens(kindText, kinds);
    for (std::size_t i = 0; i < std::min<std::size_t>(kinds.size(), 3); ++i) {
        if (kinds[i] != "domain" && kinds[i] != "space" && kinds[i] != "???" && kinds[i] != "none") {
            return cannotRead(path, "its voxels are not single numbers (axis " + std::to_string(i) + " is " +
                                        inQuotes(kinds[i]) + "); convert it to integers or floats");
        }
    }
    return sizes;
}

} // namespace voxtact::io
