// SPDX-License-Identifier: MIT
#include "io/mesh/vtk/vtk_text.h"

#include "io/errors.h"
#include "io/mesh/mesh_text.h"
#include "io/text/text_lines.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace voxtact::io {

namespace {

bool isBlank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/// The length of a text in a binary file, whose first two bits say how many bytes the length takes.
std::optional<std::uint64_t> textLength(VtkText& text) {
    const std::string_view rest = text.rest();
    if (rest.empty()) {
        return std::nullopt;
    }
    constexpr std::array<std::size_t, 4> kBytes{8, 4, 2, 1};
    const auto first = static_cast<unsigned char>(rest.front());
    const auto bytes = text.bytes(kBytes[first >> 6U]);
    if (!bytes) {
        return std::nullopt;
    }
    std::uint64_t length = first & 0x3FU;
    for (const char byte : bytes->substr(1)) {
        length = length << 8U | static_cast<unsigned char>(byte);
    }
    return length;
}

bool skipTexts(VtkText& text, bool isBinary, std::uint64_t count, std::string_view& value) {
    for (std::uint64_t i = 0; i < count; ++i) {
        std::optional<std::string_view> next;
        if (isBinary) {
            const auto length = textLength(text);
            next = length ? text.bytes(*length) : std::nullopt;
        } else {
            next = text.line();
        }
        if (!next) {
            return false;
        }
        value = i == 0 ? *next : value;
    }
    return true;
}

bool skipNumbers(VtkText& text, bool isBinary, std::string_view type, std::uint64_t count) {
    const std::optional<StoredType> known = vtkType(type);
    const bool isLong = type == "long" || type == "unsigned_long"; // 8 bytes unless written on Windows
    if (!known && !isLong && type != "bit") {
        return false;
    }
    if (isBinary) {
        const std::uint64_t bytes = known ? storedBytes(*known) : 8;
        return text.bytes(type == "bit" ? count / 8 + (count % 8 != 0 ? 1 : 0) : count * bytes).has_value();
    }
    for (std::uint64_t i = 0; i < count; ++i) {
        if (text.word().empty()) {
            return false;
        }
    }
    return true;
}

} // namespace

std::string_view VtkText::word() {
    while (at_ < content_.size() && isBlank(content_[at_])) {
        ++at_;
    }
    last_ = at_;
    while (at_ < content_.size() && !isBlank(content_[at_])) {
        ++at_;
    }
    return content_.substr(last_, at_ - last_);
}

std::optional<std::string_view> VtkText::line() {
    if (at_ == content_.size()) {
        return std::nullopt;
    }
    last_ = at_;
    const std::size_t end = std::min(content_.find('\n', at_), content_.size());
    at_ = std::min(end + 1, content_.size());
    std::string_view line = content_.substr(last_, end - last_);
    line.remove_suffix(line.ends_with('\r') ? 1 : 0);
    return line;
}

std::optional<std::string_view> VtkText::bytes(std::uint64_t count) {
    if (count > content_.size() - at_) {
        return std::nullopt;
    }
    last_ = at_;
    at_ += static_cast<std::size_t>(count);
    return content_.substr(last_, static_cast<std::size_t>(count));
}

std::uint64_t VtkText::lineNumber() const {
    const std::string_view before = content_.substr(0, last_);
    return 1 + static_cast<std::uint64_t>(std::count(before.begin(), before.end(), '\n'));
}

std::optional<StoredType> vtkType(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, StoredType>, 16> kTypes{
        {{"char", StoredType::Int8},
         {"signed_char", StoredType::Int8},
         {"unsigned_char", StoredType::UInt8},
         {"short", StoredType::Int16},
         {"unsigned_short", StoredType::UInt16},
         {"int", StoredType::Int32},
         {"unsigned_int", StoredType::UInt32},
         {"vtkidtype", StoredType::Int32},
         {"vtktypeint32", StoredType::Int32},
         {"vtktypeuint32", StoredType::UInt32},
         {"vtktypeint64", StoredType::Int64},
         {"vtktypeuint64", StoredType::UInt64},
         {"long_long", StoredType::Int64},
         {"unsigned_long_long", StoredType::UInt64},
         {"float", StoredType::Float32},
         {"double", StoredType::Float64}}};
    const auto* const found =
        std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& known) { return known.first == name; });
    return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

bool skipVtkFieldArray(VtkText& text, bool isBinary, std::string_view& name, std::string_view& value) {
    name = text.word();
    const std::optional<std::uint64_t> components = parseNatural(text.word());
    const std::optional<std::uint64_t> tuples = parseNatural(text.word());
    const std::string type = lowered(std::string(text.word()));
    if (!components || !tuples || !text.line()) {
        return false;
    }
    // More numbers than the file has bits are no array, and their count must not overflow.
    const std::uint64_t most = 8 * static_cast<std::uint64_t>(text.rest().size());
    if (*components != 0 && *tuples > most / *components) {
        return false;
    }
    const std::uint64_t count = *components * *tuples;
    return type == "string" || type == "utf8_string" ? skipTexts(text, isBinary, count, value)
                                                     : skipNumbers(text, isBinary, type, count);
}

bool skipVtkMetadata(VtkText& text) {
    static_cast<void>(text.line()); // the rest of the section's own line
    while (const auto line = text.line()) {
        if (trimmed(*line).empty()) {
            return true;
        }
    }
    return text.rest().empty();
}

} // namespace voxtact::io
