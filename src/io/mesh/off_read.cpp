// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "io/errors.h"
#include "io/mesh/mesh_file.h"
#include "io/mesh/mesh_text.h"
#include "io/text/text_lines.h"

#include <limits>

namespace voxtact::io {

namespace {

class OffReader {
  public:
    OffReader(const std::filesystem::path& path, std::string_view text, MeshFile file)
        : path_(path), lines_(text), file_(std::move(file)) {}

    Result<MeshFile> read() {
        std::uint64_t vertices = 0;
        std::uint64_t faces = 0;
        VOXTACT_TRY(readHeader(vertices, faces));
        for (std::uint64_t i = 0; i < vertices; ++i) {
            if (!nextTokens()) {
                return truncated(i, vertices, "vertices");
            }
            if (const auto reason = takeVertex()) {
                return badLine(path_, lines_.number(), *reason);
            }
        }
        for (std::uint64_t i = 0; i < faces; ++i) {
            if (!nextTokens()) {
                return truncated(i, faces, "faces");
            }
            if (const auto reason = takeFace()) {
                return badLine(path_, lines_.number(), *reason);
            }
        }
        if (nextTokens()) {
            return badLine(path_, lines_.number(),
                           "the file goes on after the " + std::to_string(faces) + " faces that its header states");
        }
        return std::move(file_);
    }

  private:
    /// The next line that is neither empty nor a comment, in tokens.
    bool nextTokens() {
        for (std::string_view line; lines_.next(line);) {
            splitTokens(line.substr(0, line.find('#')), tokens_);
            if (!tokens_.empty()) {
                return true;
            }
        }
        return false;
    }

    Result<void> readHeader(std::uint64_t& vertices, std::uint64_t& faces) {
        if (!nextTokens() || !takeKeyword(tokens_[0]) || (tokens_.size() > 1 && tokens_[1] == "BINARY")) {
            return cannotRead(path_,
                              "it is not a plain OFF file in text (it does not begin with OFF, or with ST, C and "
                              "N before that)");
        }
        // "OFF6 2 0" is common.
        tokens_[0].remove_prefix(tokens_[0].find("OFF") + 3);
        if (tokens_[0].empty()) {
            tokens_.erase(tokens_.begin());
        }
        if (tokens_.empty() && !nextTokens()) {
            tokens_.clear();
        }
        // The third, the number of edges, is ignored.
        constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
        if (tokens_.size() == 2 || tokens_.size() == 3) {
            vertices = parseNatural(tokens_[0]).value_or(kMost + 1);
            faces = parseNatural(tokens_[1]).value_or(kMost + 1);
            if (vertices <= kMost && faces <= kMost) {
                return {};
            }
        }
        return cannotRead(path_, "its OFF header does not state the numbers of vertices and faces");
    }

    /// OFF; before it, ST for texture coordinates, C for colours and N for normals of the vertices.
    bool takeKeyword(std::string_view word) {
        const std::size_t off = word.find("OFF");
        if (off == std::string_view::npos || word.find_first_not_of("0123456789", off + 3) != std::string_view::npos) {
            return false;
        }
        for (std::string_view before = word.substr(0, off); !before.empty();) {
            const bool texture = before.starts_with("ST");
            const bool colours = before.starts_with('C');
            if (!texture && !colours && !before.starts_with('N')) {
                return false;
            }
            least_ += texture ? 2 : 3;
            most_ += texture ? 2 : colours ? 4 : 3; // with alpha or without
            before.remove_prefix(texture ? 2 : 1);
        }
        return true;
    }

    [[nodiscard]] Error truncated(std::uint64_t present, std::uint64_t stated, const std::string& what) const {
        return cannotRead(path_, "it is truncated: it has " + std::to_string(present) + " of " +
                                     std::to_string(stated) + " " + what);
    }

    std::optional<std::string> takeVertex() {
        Vec3 vertex{};
        for (std::size_t i = 0; i < std::min<std::size_t>(tokens_.size(), 3); ++i) {
            if (auto reason = parseNumber(tokens_[i], vertex[i])) {
                return reason;
            }
        }
        file_.vertices.push_back(vertex);
        if (tokens_.size() >= least_ && tokens_.size() <= most_) {
            return std::nullopt;
        }
        return least_ == 3 ? "a vertex has 3 coordinates"
                           : "a vertex of this kind of OFF has " + std::to_string(least_) +
                                 (most_ == least_ ? "" : " to " + std::to_string(most_)) + " numbers, this one has " +
                                 std::to_string(tokens_.size());
    }

    /// A colour follows the corners.
    std::optional<std::string> takeFace() {
        const std::optional<std::uint64_t> corners = parseNatural(tokens_[0]);
        if (!corners || *corners < 3 || tokens_.size() <= *corners) {
            return "a face is its number of corners (3 or more) and as many vertex numbers";
        }
        for (std::size_t i = 1; i <= *corners; ++i) {
            const std::optional<std::uint64_t> vertex = parseNatural(tokens_[i]);
            if (!vertex || *vertex >= file_.vertices.size()) {
                return inQuotes(tokens_[i]) + " is not the number of one of the " +
                       std::to_string(file_.vertices.size()) + " vertices";
            }
            file_.corners.push_back(static_cast<std::uint32_t>(*vertex));
        }
        file_.faceSizes.push_back(static_cast<std::uint32_t>(*corners));
        return std::nullopt;
    }

    const std::filesystem::path& path_;
    TextLines lines_;
    std::vector<std::string_view> tokens_;
    std::size_t least_ = 3; ///< numbers of a vertex, coordinates first
    std::size_t most_ = 3;
    MeshFile file_;
};

} // namespace

Result<MeshFile> readOff(const MeshSource& source) {
    // The header states the whole content, so zeros after it hide nothing.
    MeshFile file;
    const Result<std::string_view> text = meshText(source.path, withoutPadding(source.content, file));
    VOXTACT_TRY(text);
    return OffReader(source.path, *text, std::move(file)).read();
}

} // namespace voxtact::io
