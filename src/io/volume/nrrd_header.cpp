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

std::string unescaped(std::string_view text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape = text[i] == '\\' && i + 1 < text.size();
        plain += !escape ? text[i] : text[++i] == 'n' ? '\n' : text[i];
    }
    return plain;
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
        if (const std::size_t key = text.find(":="); key < colon && !text.starts_with('#')) {
            header.keys.try_emplace(std::string(text.substr(0, key)), unescaped(text.substr(key + 2)));
        }
        if (colon != std::string_view::npos && colon < text.find(":=") && !text.starts_with('#')) {
            const std::string_view value = trimmed(text.substr(colon + 1));
            VOXTACT_TRY(addField(reader.path(), text.substr(0, colon), value, header));
            // "LIST 2" says how many axes the image of a file has.
            if (withoutBlanks(text.substr(0, colon)) == "datafile" && value.starts_with("LIST")) {
                Result<std::vector<std::string>> names = listedNames(reader);
                VOXTACT_TRY(names);
                header.listed = std::move(*names);
                break;
            }
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

Result<NrrdAxes> nrrdAxes(const fs::path& path, const NrrdHeader& header) {
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
    std::vector<std::string_view> kinds;
    const std::string kindText = header.get("kinds");
    splitTokens(kindText, kinds);
    const auto directions = nrrdVectors(header.get("spacedirections"));
    // A "domain" axis is one in space; others hold components.
    const auto isDomain = [&](std::size_t axis) {
        return axis >= kinds.size() || kinds[axis] == "domain" || kinds[axis] == "space" || kinds[axis] == "???" ||
               kinds[axis] == "none";
    };
    const auto hasDirection = [&](std::size_t axis) {
        return !directions || axis >= directions->size() || (*directions)[axis];
    };
    NrrdAxes axes;
    std::vector<std::int64_t> others;
    std::size_t inSpace = 0;
    for (std::size_t axis = 0; axis < sizes.size(); ++axis) {
        const bool isStub = sizes[axis] == 1 && (!isDomain(axis) || !hasDirection(axis));
        if (inSpace == 3 || (isStub && sizes.size() > 3)) {
            others.push_back(sizes[axis]);
            continue;
        }
        if (!isDomain(axis)) {
            return cannotRead(path, "its voxels are not single numbers (axis " + std::to_string(axis) + " is " +
                                        inQuotes(kinds[axis]) + "); convert it to integers or floats");
        }
        axes.places[inSpace++] = axis;
        axes.sizes.push_back(sizes[axis]);
    }
    if (inSpace == 3) {
        axes.sizes.insert(axes.sizes.end(), others.begin(), others.end());
    }
    return axes;
}

} // namespace voxtact::io
