// SPDX-License-Identifier: MIT
#include "io/byte_source.h"
#include "io/errors.h"
#include "io/mesh/mesh_census.h"
#include "io/text/text_lines.h"

#include <charconv>
#include <cmath>

namespace voxtact::io {

namespace {

enum class Storage { Ascii, LittleEndian, BigEndian };

struct Property {
    std::string name;
    std::string type;
    std::string countType; ///< of lists
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

struct PlyHeader {
    Storage storage = Storage::Ascii;
    std::vector<Element> elements;
    bool complete = false;
};

std::size_t typeBytes(std::string_view type) {
    if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") {
        return 1;
    }
    if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") {
        return 2;
    }
    if (type == "int" || type == "uint" || type == "int32" || type == "uint32" || type == "float" ||
        type == "float32") {
        return 4;
    }
    return type == "double" || type == "float64" ? 8 : 0;
}

/// The reason why the line is no line of a header.
std::optional<std::string> takeHeaderLine(PlyHeader& header, const std::vector<std::string_view>& tokens) {
    const std::string_view word = tokens[0];
    if (word == "comment" || word == "obj_info" || word == "ply") {
        return std::nullopt;
    }
    if (word == "format" && tokens.size() == 3) {
        header.storage = tokens[1] == "binary_little_endian" ? Storage::LittleEndian
                         : tokens[1] == "binary_big_endian"  ? Storage::BigEndian
                                                             : Storage::Ascii;
        return header.storage == Storage::Ascii && tokens[1] != "ascii"
                   ? std::optional<std::string>("unknown PLY format")
                   : std::nullopt;
    }
    if (word == "element" && tokens.size() == 3) {
        Element element{std::string(tokens[1]), 0, {}};
        const auto end = std::from_chars(tokens[2].data(), tokens[2].data() + tokens[2].size(), element.count);
        header.elements.push_back(element);
        return end.ec != std::errc{} || end.ptr != tokens[2].data() + tokens[2].size()
                   ? std::optional<std::string>("an element needs its number")
                   : std::nullopt;
    }
    const bool list = tokens.size() == 5 && tokens[1] == "list";
    if (word != "property" || header.elements.empty() || (!list && tokens.size() != 3)) {
        return "this is not a line of a PLY header";
    }
    Property property{std::string(tokens.back()), std::string(tokens[tokens.size() - 2]),
                      list ? std::string(tokens[2]) : std::string()};
    if (typeBytes(property.type) == 0 || (list && typeBytes(property.countType) == 0)) {
        return "unknown PLY type";
    }
    header.elements.back().properties.push_back(std::move(property));
    return std::nullopt;
}

/// Takes one number after the other from the body, text or binary.
class Body {
  public:
    Body(std::string_view content, Storage storage) : rest_(content), storage_(storage) {}

    /// False at the end of the file, and where the text is not a finite number (then `reason` is set).
    bool take(const std::string& type, double& value) {
        return storage_ == Storage::Ascii ? takeText(value) : takeBinary(type, value);
    }
    std::optional<std::string> reason;

  private:
    bool takeText(double& value) {
        constexpr std::string_view kBlanks = " \t\r\n\v\f";
        rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
        const std::string_view token = rest_.substr(0, rest_.find_first_of(kBlanks));
        rest_.remove_prefix(token.size());
        if (!token.empty()) {
            reason = parseNumber(token, value);
        }
        return !token.empty() && !reason;
    }

    template <class Number> double next() {
        const bool swapped = storage_ == Storage::BigEndian;
        const auto value = static_cast<double>(numberAt<Number>(rest_, 0, swapped));
        rest_.remove_prefix(sizeof(Number));
        return value;
    }

    bool takeBinary(const std::string& type, double& value) {
        if (rest_.size() < typeBytes(type)) {
            return false;
        }
        const bool isUnsigned = type.starts_with('u');
        switch (typeBytes(type)) {
        case 1:
            value = isUnsigned ? next<std::uint8_t>() : next<std::int8_t>();
            break;
        case 2:
            value = isUnsigned ? next<std::uint16_t>() : next<std::int16_t>();
            break;
        case 4:
            value = type.starts_with("float") ? next<float>()
                    : isUnsigned              ? next<std::uint32_t>()
                                              : next<std::int32_t>();
            break;
        default:
            value = next<double>();
        }
        return true;
    }

    std::string_view rest_;
    Storage storage_;
};

class PlyCensus {
  public:
    PlyCensus(std::uint64_t vertices, Body body) : vertices_(vertices), body_(std::move(body)) {}

    bool takeElement(const Element& element) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const Property& property : element.properties) {
                if (!takeProperty(element, property)) {
                    place_ = element.name + " " + std::to_string(i);
                    return false;
                }
            }
        }
        return true;
    }

    [[nodiscard]] std::string reason() const {
        return place_ + ": " +
               (reason_.empty() ? body_.reason.value_or("the file is truncated; get it again") : reason_);
    }
    [[nodiscard]] std::uint64_t triangles() const noexcept { return triangles_; }

  private:
    bool takeProperty(const Element& element, const Property& property) {
        double value = 0;
        if (property.countType.empty()) {
            return body_.take(property.type, value);
        }
        double count = 0;
        if (!body_.take(property.countType, count)) {
            return false;
        }
        const bool isFace =
            element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
        if (isFace && !(count >= 3)) {
            reason_ = "a face needs 3 corners or more, this one has " + std::to_string(static_cast<long long>(count));
            return false;
        }
        for (double i = 0; i < count; ++i) {
            if (!body_.take(property.type, value)) {
                return false;
            }
            if (isFace && !(value >= 0 && value < static_cast<double>(vertices_) && value == std::floor(value))) {
                reason_ = "it uses vertex " + std::to_string(static_cast<long long>(value)) + ", the file has " +
                          std::to_string(vertices_) + " vertices";
                return false;
            }
        }
        triangles_ += isFace ? static_cast<std::uint64_t>(count) - 2 : 0;
        return true;
    }

    std::uint64_t vertices_;
    Body body_;
    std::uint64_t triangles_ = 0;
    std::string place_;
    std::string reason_;
};

Result<PlyHeader> readHeader(const std::filesystem::path& path, TextLines& lines) {
    PlyHeader header;
    std::vector<std::string_view> tokens;
    for (std::string_view line; lines.next(line);) {
        splitTokens(line, tokens);
        if (lines.number() == 1 && (tokens.empty() || tokens[0] != "ply")) {
            return cannotRead(path, "it is not a PLY file (it does not begin with ply)");
        }
        if (!tokens.empty() && tokens[0] == "end_header") {
            header.complete = true;
            return header;
        }
        if (const auto reason = tokens.empty() ? std::nullopt : takeHeaderLine(header, tokens)) {
            return badLine(path, lines.number(), *reason);
        }
    }
    return cannotRead(path, "it is truncated: its PLY header does not end; get the file again");
}

} // namespace

Result<std::uint64_t> statedByPly(const std::filesystem::path& path, std::string_view content) {
    TextLines lines(content);
    const Result<PlyHeader> header = readHeader(path, lines);
    if (!header.ok()) {
        return header.error();
    }
    std::uint64_t vertices = 0;
    for (const Element& element : header->elements) {
        // assimp reads faces into memory that it gets with the vertices.
        if (element.name == "face" && vertices == 0) {
            return cannotRead(path, "its faces come before its vertices, or it has no vertices");
        }
        if (element.name == "tristrips") {
            return cannotRead(path, "it holds triangle strips, which are not supported; write faces");
        }
        vertices = element.name == "vertex" ? element.count : vertices;
    }
    PlyCensus census(vertices, Body(lines.rest(), header->storage));
    for (const Element& element : header->elements) {
        if (!census.takeElement(element)) {
            return cannotRead(path, census.reason());
        }
    }
    return census.triangles();
}

} // namespace voxtact::io
