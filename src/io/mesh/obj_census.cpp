// SPDX-License-Identifier: MIT
#include "io/errors.h"
#include "io/mesh/mesh_census.h"
#include "io/text/text_lines.h"

#include <algorithm>
#include <charconv>

namespace voxtact::io {

namespace {

/// Only what assimp's reader takes in the same way: it drops a vertex with 5 numbers, reads "1,5" as 1.5 and any word
/// that begins with f as a face.
class ObjCensus {
  public:
    std::optional<std::string> take(std::string_view line, std::uint64_t number) {
        splitTokens(line.substr(0, line.find('#')), tokens_);
        if (tokens_.empty()) {
            return std::nullopt;
        }
        const std::string_view word = tokens_[0];
        if (word != "v" && word != "f" && word != "l" && word != "p") {
            return word.starts_with('f') || word.starts_with('l') || word.starts_with('p')
                       ? std::optional<std::string>("'" + oneLine(word.substr(0, 40)) + "' is not supported")
                       : std::nullopt;
        }
        if (line.front() == ' ' || line.front() == '\t') {
            return "a line must not begin with a blank";
        }
        if (word == "v") {
            return vertex();
        }
        return word == "f" ? face(number) : std::nullopt;
    }

    /// Indices may be used before their vertex, so the largest is known to be right only at the end.
    [[nodiscard]] std::optional<std::string> finish() const {
        return largest_ > vertices_ ? std::optional<std::string>("a face uses vertex " + std::to_string(largest_) +
                                                                 ", the file has " + std::to_string(vertices_))
                                    : std::nullopt;
    }
    [[nodiscard]] std::uint64_t lineOfLargest() const noexcept { return lineOfLargest_; }
    [[nodiscard]] std::uint64_t triangles() const noexcept { return triangles_; }

  private:
    std::optional<std::string> vertex() {
        double w = 1;
        for (std::size_t i = 1; i < tokens_.size(); ++i) {
            double value = 0;
            if (auto reason = parseNumber(tokens_[i], value)) {
                return reason;
            }
            w = i == 4 ? value : w;
        }
        ++vertices_;
        if (tokens_.size() == 5 && w == 0) {
            return "the vertex lies at infinity (its fourth number is 0)";
        }
        return tokens_.size() == 4 || tokens_.size() == 5 || tokens_.size() == 7
                   ? std::nullopt
                   : std::optional<std::string>("a vertex has 3, 4 or 6 numbers, this one has " +
                                                std::to_string(tokens_.size() - 1));
    }

    std::optional<std::string> face(std::uint64_t number) {
        for (std::size_t i = 1; i < tokens_.size(); ++i) {
            const std::string_view corner = tokens_[i].substr(0, tokens_[i].find('/'));
            std::int64_t index = 0;
            const auto end = std::from_chars(corner.data(), corner.data() + corner.size(), index);
            const bool clean = tokens_[i].find_first_not_of("0123456789/-") == std::string_view::npos;
            if (corner.empty() || end.ec != std::errc{} || end.ptr != corner.data() + corner.size() || !clean) {
                return "'" + oneLine(tokens_[i].substr(0, 40)) + "' is not a vertex number";
            }
            if (index == 0 || (index < 0 && std::cmp_greater(-index, vertices_))) {
                return "a face uses vertex " + std::to_string(index) + ", which does not exist (" +
                       std::to_string(vertices_) + " before it)";
            }
            if (std::cmp_greater(index, largest_)) {
                largest_ = static_cast<std::uint64_t>(index);
                lineOfLargest_ = number;
            }
        }
        triangles_ += tokens_.size() > 3 ? tokens_.size() - 3 : 0;
        return std::nullopt;
    }

    std::vector<std::string_view> tokens_;
    std::uint64_t vertices_ = 0;
    std::uint64_t triangles_ = 0;
    std::uint64_t largest_ = 0;
    std::uint64_t lineOfLargest_ = 0;
};

} // namespace

Result<std::uint64_t> statedByObj(const std::filesystem::path& path, std::string_view content) {
    if (Result<void> encoding = checkEncoding(path, content); !encoding.ok()) {
        return encoding.error();
    }
    if (content.starts_with("\xEF\xBB\xBF")) {
        content.remove_prefix(3);
    }
    ObjCensus census;
    TextLines lines(content);
    std::string joined;
    for (std::string_view line; lines.next(line);) {
        const bool continues = line.ends_with('\\');
        joined += continues ? line.substr(0, line.size() - 1) : line;
        if (continues) {
            joined += ' ';
            continue;
        }
        if (const auto reason = census.take(joined, lines.number())) {
            return badLine(path, lines.number(), *reason);
        }
        joined.clear();
    }
    if (!joined.empty()) {
        return cannotRead(path, "it is truncated: its last line continues on one that is not there");
    }
    if (const auto reason = census.finish()) {
        return badLine(path, census.lineOfLargest(), *reason);
    }
    return census.triangles();
}

} // namespace voxtact::io
