// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "io/byte_source.h"
#include "io/errors.h"
#include "io/mesh/mesh_file.h"
#include "io/mesh/mesh_text.h"
#include "io/text/text_lines.h"

#include <limits>

namespace voxtact::io {

namespace {

constexpr std::uint64_t kHeaderBytes = 84;
constexpr std::uint64_t kTriangleBytes = 50;
constexpr std::size_t kNormalBytes = 12;
constexpr std::size_t kMostVertices = std::numeric_limits<std::uint32_t>::max();

std::string lowered(std::string_view word) {
    std::string text(word);
    for (char& c : text) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return text;
}

void addTriangle(MeshFile& file, const std::array<Vec3, 3>& corners) {
    for (const Vec3& corner : corners) {
        file.corners.push_back(static_cast<std::uint32_t>(file.vertices.size()));
        file.vertices.push_back(corner);
    }
    file.faceSizes.push_back(3);
}

/// solid, facet, outer loop, three vertices, endloop, endfacet, endsolid: the only order there is. In any case.
class AsciiStl {
  public:
    explicit AsciiStl(MeshFile& file) : file_(file) {}

    /// The reason why the line cannot come here.
    std::optional<std::string> take(const std::vector<std::string_view>& tokens) {
        const std::string word = lowered(tokens[0]);
        if (word == "solid") {
            for (const std::string_view token : tokens) {
                takeSpace(token, file_);
            }
        }
        if (word == "vertex") {
            return vertex(tokens);
        }
        if (word == "solid") {
            return enter(!inSolid_ && !inFacet_, inSolid_, true);
        }
        if (word == "endsolid") {
            return enter(inSolid_ && !inFacet_, inSolid_, false);
        }
        if (word == "facet") {
            count_ = 0;
            return enter(inSolid_ && !inFacet_, inFacet_, true);
        }
        if (word == "outer") {
            return enter(inFacet_ && !inLoop_, inLoop_, true);
        }
        if (word == "endloop") {
            return enter(inLoop_, inLoop_, false);
        }
        return word == "endfacet" ? endFacet() : inQuotes(tokens[0]) + " is no word of an STL file";
    }

    [[nodiscard]] bool isOpen() const noexcept { return inSolid_; }

  private:
    static std::optional<std::string> enter(bool allowed, bool& state, bool value) {
        state = value;
        return allowed ? std::nullopt : std::optional<std::string>("this word cannot come here");
    }

    std::optional<std::string> vertex(const std::vector<std::string_view>& tokens) {
        if (!inLoop_ || tokens.size() != 4) {
            return inLoop_ ? "a vertex has 3 coordinates" : "a vertex must be in a loop";
        }
        Vec3 ignored{};
        Vec3& corner = count_ < 3 ? corners_[count_] : ignored;
        ++count_;
        for (std::size_t i = 0; i < 3; ++i) {
            if (auto reason = parseNumber(tokens[i + 1], corner[i])) {
                return reason;
            }
        }
        return std::nullopt;
    }

    std::optional<std::string> endFacet() {
        if (count_ != 3) {
            return "a facet needs 3 vertices, this one has " + std::to_string(count_);
        }
        if (file_.vertices.size() > kMostVertices - 3) {
            return "it has more triangles than 32 bits count";
        }
        addTriangle(file_, corners_);
        return enter(inFacet_ && !inLoop_, inFacet_, false);
    }

    MeshFile& file_;
    bool inSolid_ = false;
    bool inFacet_ = false;
    bool inLoop_ = false;
    std::uint64_t count_ = 0;
    std::array<Vec3, 3> corners_{};
};

Result<MeshFile> readAscii(const MeshSource& source) {
    // Some programs end the text with a zero.
    MeshFile file;
    const Result<std::string_view> text = meshText(source.path, withoutPadding(source.content, file));
    VOXTACT_TRY(text);
    AsciiStl stl(file);
    TextLines lines(*text);
    std::vector<std::string_view> tokens;
    for (std::string_view line; lines.next(line);) {
        splitTokens(line, tokens);
        if (tokens.empty()) {
            continue;
        }
        if (const auto reason = stl.take(tokens)) {
            return badLine(source.path, lines.number(), *reason);
        }
    }
    if (stl.isOpen()) {
        return cannotRead(source.path,
                          "it is truncated: no line after its last 'solid' begins with 'endsolid'; get the file again");
    }
    return file;
}

/// The content has the length that its header states, or some bytes more.
Result<MeshFile> readBinary(const MeshSource& source, std::size_t length) {
    if (length / kTriangleBytes > kMostVertices / 3) {
        return cannotRead(source.path, "it has more triangles than 32 bits count");
    }
    MeshFile file;
    takeSpace(source.content.substr(0, kHeaderBytes), file);
    if (const std::size_t more = source.content.size() - length; more != 0) {
        file.notes.push_back(std::to_string(more) + (more == 1 ? " byte" : " bytes") +
                             " behind the triangles that the header states left out");
    }
    for (std::size_t at = kHeaderBytes; at < length; at += kTriangleBytes) {
        std::array<Vec3, 3> corners{};
        for (std::size_t i = 0; i < 9; ++i) {
            corners[i / 3][i % 3] =
                static_cast<double>(numberAt<float>(source.content, at + kNormalBytes + sizeof(float) * i));
        }
        addTriangle(file, corners);
    }
    return file;
}

} // namespace

Result<MeshFile> readStl(const MeshSource& source) {
    const std::string_view content = source.content;
    // A binary file may begin with the word of the text; its length tells.
    const std::uint64_t stated = content.size() < kHeaderBytes ? 0 : numberAt<std::uint32_t>(content, 80);
    const std::uint64_t length = kHeaderBytes + kTriangleBytes * stated;
    if (content.size() >= kHeaderBytes && content.size() == length) {
        return readBinary(source, content.size());
    }
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    const std::string_view text = content.substr(content.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0, 4096);
    const bool looksBinary = text.substr(0, text.find_last_not_of(kPadding) + 1).find('\0') != std::string_view::npos;
    if (!looksBinary && lowered(trimmed(text).substr(0, 5)) == "solid") {
        return readAscii(source);
    }
    MeshFile ignored;
    if (stated != 0 && content.size() > length &&
        (content.size() - length < kTriangleBytes || takePadding(content.substr(length), ignored))) {
        return readBinary(source, length);
    }
    if (content.size() < kHeaderBytes) {
        return cannotRead(source.path,
                          "it is not an STL file, or it is truncated (" + std::to_string(content.size()) + " bytes)");
    }
    return cannotRead(
        source.path,
        std::string(content.size() < length ? "it is truncated: " : "it is not a proper binary STL file: ") + "the " +
            std::to_string(stated) + " triangles that its header states take " + std::to_string(length) + " bytes, " +
            std::to_string(content.size()) + " are there");
}

} // namespace voxtact::io
