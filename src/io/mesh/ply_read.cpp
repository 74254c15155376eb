// SPDX-License-Identifier: MIT
#include "core/base/text.h"

#include "core/base/try.h"
#include "io/byte_source.h"
#include "io/errors.h"
#include "io/mesh/mesh_file.h"
#include "io/mesh/ply_header.h"
#include "io/text/text_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace voxtact::io {

namespace {

/// Requested numbers of a row of an element, by property.
struct Row {
    std::vector<bool> wanted;                ///< by property
    std::vector<std::vector<double>> values; ///< by property; empty where not wanted
};

/// Takes one row after the other from the body.
class Body {
  public:
    virtual ~Body() = default;
    /// The reason why there is no such row.
    virtual std::optional<std::string> take(const PlyElement& element, Row& row) = 0;
    /// Returns the rest after the last row.
    [[nodiscard]] virtual std::string_view rest() const = 0;
};

constexpr const char* kTruncated = "the file is truncated; get it again";

/// A row is a line.
class TextBody final : public Body {
  public:
    explicit TextBody(TextLines lines) : lines_(lines) {}

    std::optional<std::string> take(const PlyElement& element, Row& row) override {
        do {
            std::string_view line;
            if (!lines_.next(line)) {
                return kTruncated;
            }
            splitTokens(line, tokens_);
        } while (tokens_.empty());
        rest_ = tokens_;
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            std::uint64_t count = 1;
            if (element.properties[i].countType) {
                const auto stated = rest_.empty() ? std::nullopt : parseNatural(rest_.front());
                if (!stated) {
                    return rest_.empty() ? tooFew() : inQuotes(rest_.front()) + " is not the length of a list";
                }
                count = *stated;
                rest_ = rest_.subspan(1);
            }
            if (count > rest_.size()) {
                return tooFew();
            }
            if (row.wanted[i]) {
                if (auto reason = parse(rest_.first(count), row.values[i])) {
                    return reason;
                }
            }
            rest_ = rest_.subspan(count);
        }
        return rest_.empty() ? std::nullopt
                             : std::optional<std::string>("its line has more numbers than the header states");
    }

    [[nodiscard]] std::string_view rest() const override { return lines_.rest(); }

  private:
    [[nodiscard]] std::string tooFew() const {
        return trimmed(lines_.rest()).empty() ? kTruncated : "its line has fewer numbers than the header states";
    }

    static std::optional<std::string> parse(std::span<const std::string_view> tokens, std::vector<double>& values) {
        values.resize(tokens.size());
        for (std::size_t i = 0; i < tokens.size(); ++i) {
            if (auto reason = parseNumber(tokens[i], values[i])) {
                return reason;
            }
        }
        return std::nullopt;
    }

    TextLines lines_;
    std::vector<std::string_view> tokens_;
    std::span<const std::string_view> rest_;
};

class BinaryBody final : public Body {
  public:
    BinaryBody(std::string_view bytes, bool swapped) : rest_(bytes), swapped_(swapped) {}

    std::optional<std::string> take(const PlyElement& element, Row& row) override {
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            std::uint64_t count = 1;
            if (property.countType) {
                if (rest_.size() < plyBytes(*property.countType)) {
                    return kTruncated;
                }
                const double stated = next(*property.countType);
                constexpr double kFar = 1e15; // no file is that long
                if (!(stated >= 0 && stated < kFar)) {
                    return "the length of a list is negative or beyond all reason";
                }
                count = static_cast<std::uint64_t>(stated);
            }
            const std::size_t bytes = plyBytes(property.type);
            if (rest_.size() / bytes < count) {
                return kTruncated;
            }
            if (!row.wanted[i]) {
                rest_.remove_prefix(count * bytes);
                continue;
            }
            row.values[i].resize(count);
            for (double& value : row.values[i]) {
                value = next(property.type);
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] std::string_view rest() const override { return rest_; }

  private:
    template <class Number> double number() {
        const auto value = static_cast<double>(numberAt<Number>(rest_, 0, swapped_));
        rest_.remove_prefix(sizeof(Number));
        return value;
    }

    double next(PlyType type) {
        switch (type) {
        case PlyType::Int8:
            return number<std::int8_t>();
        case PlyType::UInt8:
            return number<std::uint8_t>();
        case PlyType::Int16:
            return number<std::int16_t>();
        case PlyType::UInt16:
            return number<std::uint16_t>();
        case PlyType::Int32:
            return number<std::int32_t>();
        case PlyType::UInt32:
            return number<std::uint32_t>();
        case PlyType::Int64:
            return number<std::int64_t>();
        case PlyType::UInt64:
            return number<std::uint64_t>();
        case PlyType::Float:
            return number<float>();
        case PlyType::Double:
            break;
        }
        return number<double>();
    }

    std::string_view rest_;
    bool swapped_;
};

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

std::size_t placeOf(const PlyElement& element, std::string_view name) {
    const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                    [&](const PlyProperty& property) { return property.name == name; });
    return found == element.properties.end() ? kNone : static_cast<std::size_t>(found - element.properties.begin());
}

class PlyReader {
  public:
    PlyReader(const PlyHeader& header, Body& body) : header_(header), body_(body) {}

    /// The reason why the file cannot be used.
    std::optional<std::string> read() {
        takeSpace(header_.comments, file_);
        for (const PlyElement& element : header_.elements) {
            vertices_ = element.name == "vertex" ? element.count : vertices_;
        }
        if (vertices_ > std::numeric_limits<std::uint32_t>::max()) {
            return "it states more vertices than 32 bits count";
        }
        for (const PlyElement& element : header_.elements) {
            if (element.properties.empty() && element.count != 0) {
                return "its element " + inQuotes(element.name) + " has no properties";
            }
            if (auto reason = takeElement(element)) {
                return reason;
            }
        }
        return takePadding(body_.rest(), file_) ? std::nullopt
                                                : std::optional<std::string>("it holds more than its header states");
    }

    [[nodiscard]] MeshFile& file() noexcept { return file_; }

  private:
    std::optional<std::string> takeElement(const PlyElement& element) {
        Row row{std::vector<bool>(element.properties.size(), false),
                std::vector<std::vector<double>>(element.properties.size())};
        std::array<std::size_t, 3> xyz{kNone, kNone, kNone};
        std::size_t corners = kNone;
        if (element.name == "vertex") {
            xyz = {placeOf(element, "x"), placeOf(element, "y"), placeOf(element, "z")};
            for (const std::size_t place : xyz) {
                if (place == kNone || element.properties[place].countType) {
                    return "its vertices have no x, y and z";
                }
                row.wanted[place] = true;
            }
        } else if ((element.name == "face" || element.name == "tristrips") && element.count != 0) {
            corners = std::min(placeOf(element, "vertex_indices"), placeOf(element, "vertex_index"));
            if (corners == kNone || !element.properties[corners].countType ||
                element.properties[corners].type >= PlyType::Float) {
                return "its " + std::string(element.name == "face" ? "faces" : "tristrips") +
                       " have no list vertex_indices of whole numbers";
            }
            row.wanted[corners] = true;
        } else if (element.name == "edge") {
            file_.pointsAndLines += element.count;
        }
        for (std::uint64_t i = 0; i < element.count; ++i) {
            std::optional<std::string> reason = body_.take(element, row);
            if (!reason && element.name == "vertex") {
                file_.vertices.push_back({row.values[xyz[0]][0], row.values[xyz[1]][0], row.values[xyz[2]][0]});
            } else if (!reason && corners != kNone) {
                reason = element.name == "face" ? addFace(row.values[corners]) : addStrips(row.values[corners]);
            }
            if (reason) {
                return std::string(trimmed(element.name.substr(0, 40))) + " " + std::to_string(i) + ": " + *reason;
            }
        }
        return std::nullopt;
    }

    std::optional<std::string> addFace(const std::vector<double>& face) {
        if (face.size() < 3) {
            return "a face needs 3 corners or more, this one has " + std::to_string(face.size());
        }
        for (const double corner : face) {
            if (auto reason = checkCorner(corner)) {
                return reason;
            }
            file_.corners.push_back(static_cast<std::uint32_t>(corner));
        }
        file_.faceSizes.push_back(static_cast<std::uint32_t>(face.size()));
        return std::nullopt;
    }

    /// Strips in one list, with -1 between them.
    std::optional<std::string> addStrips(const std::vector<double>& corners) {
        std::vector<std::uint32_t> strip;
        for (std::size_t i = 0; i <= corners.size(); ++i) {
            if (i < corners.size() && corners[i] != -1) {
                if (auto reason = checkCorner(corners[i])) {
                    return reason;
                }
                strip.push_back(static_cast<std::uint32_t>(corners[i]));
                continue;
            }
            if (!strip.empty() && strip.size() < 3) {
                return "a strip needs 3 corners or more, this one has " + std::to_string(strip.size());
            }
            addStrip(strip, file_);
            strip.clear();
        }
        return std::nullopt;
    }

    [[nodiscard]] std::optional<std::string> checkCorner(double corner) const {
        const bool isVertex = corner >= 0 && corner < static_cast<double>(vertices_) && corner == std::floor(corner);
        return isVertex ? std::nullopt
                        : std::optional<std::string>("it uses vertex " + voxtact::number(corner) + ", the file has " +
                                                     std::to_string(vertices_) + " vertices");
    }

    const PlyHeader& header_;
    Body& body_;
    std::uint64_t vertices_ = 0;
    MeshFile file_;
};

Result<MeshFile> readBody(const MeshSource& source, const PlyHeader& header, Body& body) {
    PlyReader reader(header, body);
    if (const auto reason = reader.read()) {
        return cannotRead(source.path, *reason);
    }
    return std::move(reader.file());
}

} // namespace

Result<MeshFile> readPly(const MeshSource& source) {
    TextLines lines(source.content);
    const Result<PlyHeader> header = readPlyHeader(source.path, lines);
    VOXTACT_TRY(header);
    if (header->storage == PlyStorage::Ascii) {
        TextBody body(lines);
        return readBody(source, *header, body);
    }
    BinaryBody body(lines.rest(), header->storage == PlyStorage::BigEndian);
    return readBody(source, *header, body);
}

} // namespace voxtact::io
