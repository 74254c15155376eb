// SPDX-License-Identifier: MIT
#include "io/mesh/ply_header.h"

#include "io/errors.h"
#include "io/text/text_lines.h"

#include <algorithm>

namespace voxtact::io {

namespace {

using Tokens = std::vector<std::string_view>;

std::optional<PlyType> typeNamed(std::string_view name) {
    struct Named {
        std::string_view first;
        std::string_view second;
        PlyType type;
    };
    constexpr Named kTypes[] = {{"char", "int8", PlyType::Int8},      {"uchar", "uint8", PlyType::UInt8},
                                {"short", "int16", PlyType::Int16},   {"ushort", "uint16", PlyType::UInt16},
                                {"int", "int32", PlyType::Int32},     {"uint", "uint32", PlyType::UInt32},
                                {"long", "int64", PlyType::Int64},    {"ulong", "uint64", PlyType::UInt64},
                                {"float", "float32", PlyType::Float}, {"double", "float64", PlyType::Double}};
    const auto* const found = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const Named& named) {
        return name == named.first || name == named.second;
    });
    return found == std::end(kTypes) ? std::nullopt : std::optional(found->type);
}

class HeaderReader {
  public:
    /// The reason why the line is no line of a header.
    std::optional<std::string> take(const Tokens& tokens) {
        const std::string_view word = tokens[0];
        if (word == "comment" || word == "obj_info") {
            for (const std::string_view token : tokens) {
                header_.comments += " " + std::string(token);
            }
            return std::nullopt;
        }
        if (word == "format" && tokens.size() == 3) {
            return format(tokens[1]);
        }
        if (word == "element" && tokens.size() == 3) {
            return element(tokens);
        }
        if (word == "property" && !header_.elements.empty()) {
            return property(tokens);
        }
        return "this is not a line of a PLY header";
    }

    [[nodiscard]] bool hasFormat() const noexcept { return hasFormat_; }
    [[nodiscard]] PlyHeader& header() noexcept { return header_; }

  private:
    std::optional<std::string> format(std::string_view name) {
        header_.storage = name == "binary_little_endian" ? PlyStorage::LittleEndian
                          : name == "binary_big_endian"  ? PlyStorage::BigEndian
                                                         : PlyStorage::Ascii;
        hasFormat_ = true;
        return header_.storage == PlyStorage::Ascii && name != "ascii"
                   ? std::optional<std::string>("unknown PLY format")
                   : std::nullopt;
    }

    std::optional<std::string> element(const Tokens& tokens) {
        const std::optional<std::uint64_t> count = parseNatural(tokens[2]);
        for (const PlyElement& other : header_.elements) {
            if (other.name == tokens[1]) {
                return "there are two elements of this name";
            }
        }
        header_.elements.push_back({std::string(tokens[1]), count.value_or(0), {}});
        return count ? std::nullopt : std::optional<std::string>("an element needs its number");
    }

    std::optional<std::string> property(const Tokens& tokens) {
        const bool list = tokens.size() == 5 && tokens[1] == "list";
        if (!list && tokens.size() != 3) {
            return "this is not a line of a PLY header";
        }
        const std::optional<PlyType> type = typeNamed(tokens[tokens.size() - 2]);
        const std::optional<PlyType> countType = list ? typeNamed(tokens[2]) : std::nullopt;
        if (!type || (list && !countType)) {
            return "unknown PLY type";
        }
        if (list && *countType >= PlyType::Float) {
            return "the length of a list is of a type that is not whole";
        }
        std::vector<PlyProperty>& properties = header_.elements.back().properties;
        for (const PlyProperty& other : properties) {
            if (other.name == tokens.back()) {
                return "the element has two properties of this name";
            }
        }
        properties.push_back({std::string(tokens.back()), *type, countType});
        return std::nullopt;
    }

    PlyHeader header_;
    bool hasFormat_ = false;
};

} // namespace

Result<PlyHeader> readPlyHeader(const std::filesystem::path& path, TextLines& lines) {
    HeaderReader reader;
    Tokens tokens;
    for (std::string_view line; lines.next(line);) {
        splitTokens(line, tokens);
        if (lines.number() == 1) {
            if (tokens.size() != 1 || tokens[0] != "ply") {
                return cannotRead(path, "it is not a PLY file (it does not begin with ply)");
            }
            continue;
        }
        if (!tokens.empty() && tokens[0] == "end_header") {
            if (!reader.hasFormat()) {
                return cannotRead(path, "its PLY header has no format");
            }
            return std::move(reader.header());
        }
        if (const auto reason = tokens.empty() ? std::nullopt : reader.take(tokens)) {
            return badLine(path, lines.number(), *reason);
        }
    }
    return cannotRead(path, "it is truncated: its PLY header does not end; get the file again");
}

} // namespace voxtact::io
