// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "io/errors.h"
#include "io/mesh/mesh_file.h"
#include "io/mesh/mesh_text.h"
#include "io/text/text_lines.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace voxtact::io {

namespace {

/// Keywords without effect on the surface: names, groups, materials, normals, texture coordinates, display.
constexpr std::array<std::string_view, 17> kNoGeometry{"vt",  "vn",       "vp",       "g",          "o",        "s",
                                                       "mg",  "usemtl",   "mtllib",   "usemap",     "maplib",   "bevel",
                                                       "lod", "c_interp", "d_interp", "shadow_obj", "trace_obj"};
/// Words of curved surfaces and of included files.
constexpr std::array<std::string_view, 23> kUnsupported{
    "cstype", "deg", "bmat",  "step",  "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp",
    "end",    "con", "ctech", "stech", "call", "csh",   "bsp",  "bzp",  "cdc",  "cdp",  "res"};

template <std::size_t Size> bool isOneOf(std::string_view word, const std::array<std::string_view, Size>& words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

class ObjReader {
  public:
    /// The reason why the line cannot be used.
    std::optional<std::string> take(std::string_view line, std::uint64_t number) {
        const std::size_t comment = std::min(line.find('#'), line.size());
        takeSpace(line.substr(comment), file_);
        splitTokens(line.substr(0, comment), tokens_);
        if (tokens_.empty()) {
            return std::nullopt;
        }
        const std::string_view word = tokens_[0];
        if (word == "v") {
            return vertex();
        }
        // `fo` is the name of faces before 1992.
        if (word == "f" || word == "fo" || word == "l" || word == "p") {
            return element(word.front(), number);
        }
        if (isOneOf(word, kUnsupported)) {
            return inQuotes(word) + " is not supported (curved surfaces, included files); write polygons";
        }
        // A damaged `v` or `f` would be such a word, and all numbers after it would be wrong.
        return isOneOf(word, kNoGeometry) ? std::nullopt
                                          : std::optional<std::string>(inQuotes(word) + " is no word of an OBJ file");
    }

    /// Indices may be used before their vertex, so the largest is known to be right only at the end.
    [[nodiscard]] std::optional<std::string> finish() const {
        return largest_ > file_.vertices.size()
                   ? std::optional<std::string>("a face uses vertex " + std::to_string(largest_) + ", the file has " +
                                                std::to_string(file_.vertices.size()))
                   : std::nullopt;
    }
    [[nodiscard]] std::uint64_t lineOfLargest() const noexcept { return lineOfLargest_; }
    [[nodiscard]] MeshFile takeFile() {
        if (empty_ != 0) {
            file_.notes.push_back(std::to_string(empty_) + " faces or lines without a corner left out");
        }
        return std::move(file_);
    }

  private:
    /// x y z, x y z w, or x y z r g b.
    std::optional<std::string> vertex() {
        std::array<double, 6> values{};
        for (std::size_t i = 1; i < tokens_.size(); ++i) {
            if (auto reason = parseNumber(tokens_[i], values[std::min<std::size_t>(i - 1, 5)])) {
                return reason;
            }
        }
        if (tokens_.size() != 4 && tokens_.size() != 5 && tokens_.size() != 7) {
            return "a vertex has 3, 4 or 6 numbers, this one has " + std::to_string(tokens_.size() - 1);
        }
        // The format gives weights a meaning for curved surfaces only. Some programs divide by them, most do not.
        if (tokens_.size() == 5 && values[3] != 1) {
            return "the vertex has the weight " + std::string(tokens_[4].substr(0, 40)) +
                   ", which programs read in different ways; write vertices with 3 numbers";
        }
        if (file_.vertices.size() == std::numeric_limits<std::uint32_t>::max()) {
            return "it has more vertices than 32 bits count";
        }
        file_.vertices.push_back({values[0], values[1], values[2]});
        return std::nullopt;
    }

    std::optional<std::string> element(char kind, std::uint64_t line) {
        const std::size_t size = tokens_.size() - 1;
        if (size == 0) {
            ++empty_;
            return std::nullopt;
        }
        const std::size_t begin = file_.corners.size();
        for (std::size_t i = 1; i < tokens_.size(); ++i) {
            std::uint32_t vertex = 0;
            if (auto reason = corner(tokens_[i], line, vertex)) {
                return reason;
            }
            file_.corners.push_back(vertex);
        }
        // Some programs write an edge as a face of two corners.
        if (kind == 'f' && size >= 3) {
            file_.faceSizes.push_back(static_cast<std::uint32_t>(size));
            return std::nullopt;
        }
        file_.corners.resize(begin);
        file_.pointsAndLines += kind == 'p' ? size : kind == 'l' && size > 1 ? size - 1 : 1;
        return std::nullopt;
    }

    /// vertex, vertex/texture, vertex//normal or vertex/texture/normal; from 1, or backwards from -1.
    std::optional<std::string> corner(std::string_view token, std::uint64_t line, std::uint32_t& vertex) {
        const std::string_view text = token.substr(0, token.find('/'));
        std::int64_t index = 0;
        const auto end = std::from_chars(text.data(), text.data() + text.size(), index);
        const bool clean = token.find_first_not_of("0123456789/-") == std::string_view::npos;
        constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
        if (text.empty() || end.ec != std::errc{} || end.ptr != text.data() + text.size() || !clean) {
            return inQuotes(token) + " is not a vertex number";
        }
        const auto count = static_cast<std::int64_t>(file_.vertices.size());
        if (index == 0 || index > kMost || index < -count) {
            return "a face uses vertex " + std::to_string(index) + ", which does not exist (" + std::to_string(count) +
                   " before it)";
        }
        if (index > 0 && static_cast<std::uint64_t>(index) > largest_) {
            largest_ = static_cast<std::uint64_t>(index);
            lineOfLargest_ = line;
        }
        vertex = static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index);
        return std::nullopt;
    }

    std::vector<std::string_view> tokens_;
    MeshFile file_;
    std::uint64_t empty_ = 0; ///< faces and lines without a corner
    std::uint64_t largest_ = 0;
    std::uint64_t lineOfLargest_ = 0;
};

} // namespace

Result<MeshFile> readObj(const MeshSource& source) {
    const Result<std::string_view> text = meshText(source.path, source.content);
    VOXTACT_TRY(text);
    ObjReader reader;
    TextLines lines(*text);
    std::string joined;
    for (std::string_view line; lines.next(line);) {
        // A comment may end with the path of a folder.
        const bool continues = line.ends_with('\\') && line.find('#') == std::string_view::npos;
        if (continues || !joined.empty()) {
            joined += continues ? line.substr(0, line.size() - 1) : line;
            joined += ' ';
        }
        if (continues) {
            continue;
        }
        if (const auto reason = reader.take(joined.empty() ? line : joined, lines.number())) {
            return badLine(source.path, lines.number(), *reason);
        }
        joined.clear();
    }
    if (!joined.empty()) {
        return cannotRead(source.path, "it is truncated: its last line continues on one that is not there");
    }
    if (const auto reason = reader.finish()) {
        return badLine(source.path, reader.lineOfLargest(), *reason);
    }
    return reader.takeFile();
}

} // namespace voxtact::io
