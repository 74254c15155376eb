// SPDX-License-Identifier: MIT
#include "io/byte_source.h"
#include "io/errors.h"
#include "io/mesh/mesh_census.h"
#include "io/text/text_lines.h"

namespace voxtact::io {

namespace {

constexpr std::uint64_t kHeaderBytes = 84;
constexpr std::uint64_t kTriangleBytes = 50;

std::string lowered(std::string_view word) {
    std::string text(word);
    for (char& c : text) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return text;
}

/// solid, facet, outer loop, three vertices, endloop, endfacet, endsolid: the only order there is.
class AsciiStl {
  public:
    /// The reason why the line cannot come here.
    std::optional<std::string> take(const std::vector<std::string_view>& tokens) {
        const std::string word = lowered(tokens[0]);
        if (word == "solid") {
            return enter(!inSolid_ && !inFacet_, inSolid_, true);
        }
        if (word == "endsolid") {
            return enter(inSolid_ && !inFacet_, inSolid_, false);
        }
        if (word == "facet") {
            corners_ = 0;
            return enter(inSolid_ && !inFacet_, inFacet_, true);
        }
        if (word == "outer") {
            return enter(inFacet_ && !inLoop_, inLoop_, true);
        }
        if (word == "endloop") {
            return enter(inLoop_, inLoop_, false);
        }
        if (word == "endfacet") {
            ++triangles_;
            return corners_ != 3 ? std::optional<std::string>("a facet needs 3 vertices, this one has " +
                                                              std::to_string(corners_))
                                 : enter(inFacet_ && !inLoop_, inFacet_, false);
        }
        return word == "vertex" ? vertex(tokens)
                                : "'" + oneLine(tokens[0].substr(0, 40)) + "' is no word of an STL file";
    }

    [[nodiscard]] bool isOpen() const noexcept { return inSolid_; }
    [[nodiscard]] std::uint64_t triangles() const noexcept { return triangles_; }

  private:
    static std::optional<std::string> enter(bool allowed, bool& state, bool value) {
        state = value;
        return allowed ? std::nullopt : std::optional<std::string>("this word cannot come here");
    }

    std::optional<std::string> vertex(const std::vector<std::string_view>& tokens) {
        if (!inLoop_ || tokens.size() != 4) {
            return inLoop_ ? "a vertex has 3 coordinates" : "a vertex must be in a loop";
        }
        ++corners_;
        double ignored = 0;
        for (std::size_t i = 1; i < tokens.size(); ++i) {
            if (auto reason = parseNumber(tokens[i], ignored)) {
                return reason;
            }
        }
        return std::nullopt;
    }

    bool inSolid_ = false;
    bool inFacet_ = false;
    bool inLoop_ = false;
    unsigned corners_ = 0;
    std::uint64_t triangles_ = 0;
};

Result<std::uint64_t> countAscii(const std::filesystem::path& path, std::string_view content) {
    if (Result<void> encoding = checkEncoding(path, content); !encoding.ok()) {
        return encoding.error();
    }
    AsciiStl stl;
    TextLines lines(content);
    std::vector<std::string_view> tokens;
    for (std::string_view line; lines.next(line);) {
        splitTokens(line, tokens);
        if (tokens.empty()) {
            continue;
        }
        if (const auto reason = stl.take(tokens)) {
            return badLine(path, lines.number(), *reason);
        }
    }
    if (stl.isOpen()) {
        return cannotRead(path, "it is truncated: it does not end with 'endsolid'; get the file again");
    }
    return stl.triangles();
}

} // namespace

Result<std::uint64_t> statedByStl(const std::filesystem::path& path, std::string_view content) {
    const bool saysSolid = content.starts_with("solid") || trimmed(content.substr(0, 80)).starts_with("solid");
    const std::uint64_t stated = content.size() < kHeaderBytes ? 0 : numberAt<std::uint32_t>(content, 80);
    const std::uint64_t length = kHeaderBytes + kTriangleBytes * stated;
    if (content.size() >= kHeaderBytes && content.size() == length) {
        return stated;
    }
    const bool looksBinary = content.substr(0, 4096).find('\0') != std::string_view::npos;
    if (saysSolid && !looksBinary) {
        return countAscii(path, content);
    }
    if (content.size() < kHeaderBytes) {
        return cannotRead(path,
                          "it is not an STL file, or it is truncated (" + std::to_string(content.size()) + " bytes)");
    }
    return cannotRead(
        path, std::string(content.size() < length ? "it is truncated: " : "it is not a proper binary STL file: ") +
                  "the " + std::to_string(stated) + " triangles that its header states take " + std::to_string(length) +
                  " bytes, " + std::to_string(content.size()) + " are there");
}

} // namespace voxtact::io
