// SPDX-License-Identifier: MIT
#include "io/errors.h"
#include "io/mesh/mesh_census.h"
#include "io/text/text_lines.h"

#include <charconv>

namespace voxtact::io {

namespace {

/// The next line that is neither empty nor a comment, in tokens.
bool nextTokens(TextLines& lines, std::vector<std::string_view>& tokens) {
    for (std::string_view line; lines.next(line);) {
        splitTokens(line.substr(0, line.find('#')), tokens);
        if (!tokens.empty()) {
            return true;
        }
    }
    return false;
}

bool parseCount(std::string_view token, std::uint64_t& value) {
    const auto end = std::from_chars(token.data(), token.data() + token.size(), value);
    return end.ec == std::errc{} && end.ptr == token.data() + token.size();
}

Result<std::uint64_t> countFaces(const std::filesystem::path& path, TextLines& lines, std::uint64_t vertices,
                                 std::uint64_t faces) {
    std::vector<std::string_view> tokens;
    std::uint64_t triangles = 0;
    for (std::uint64_t face = 0; face < faces; ++face) {
        if (!nextTokens(lines, tokens)) {
            return cannotRead(path, "it is truncated: it has " + std::to_string(face) + " of " + std::to_string(faces) +
                                        " faces");
        }
        std::uint64_t corners = 0;
        if (!parseCount(tokens[0], corners) || corners < 3 || tokens.size() <= corners) {
            return badLine(path, lines.number(),
                           "a face is its number of corners (3 or more) and as many vertex numbers");
        }
        for (std::size_t i = 1; i <= corners; ++i) {
            std::uint64_t index = 0;
            if (!parseCount(tokens[i], index) || index >= vertices) {
                return badLine(path, lines.number(),
                               "'" + oneLine(tokens[i].substr(0, 40)) + "' is not the number of one of the " +
                                   std::to_string(vertices) + " vertices");
            }
        }
        triangles += corners - 2;
    }
    return triangles;
}

} // namespace

Result<std::uint64_t> statedByOff(const std::filesystem::path& path, std::string_view content) {
    if (Result<void> encoding = checkEncoding(path, content); !encoding.ok()) {
        return encoding.error();
    }
    TextLines lines(content);
    std::vector<std::string_view> tokens;
    if (!nextTokens(lines, tokens) || tokens[0] != "OFF") {
        return cannotRead(path, "it is not a plain OFF file (it does not begin with OFF)");
    }
    tokens.erase(tokens.begin());
    std::uint64_t vertices = 0;
    std::uint64_t faces = 0;
    if ((tokens.empty() && !nextTokens(lines, tokens)) || tokens.size() < 2 || !parseCount(tokens[0], vertices) ||
        !parseCount(tokens[1], faces)) {
        return cannotRead(path, "its OFF header does not state the numbers of vertices and faces");
    }
    for (std::uint64_t vertex = 0; vertex < vertices; ++vertex) {
        if (!nextTokens(lines, tokens)) {
            return cannotRead(path, "it is truncated: it has " + std::to_string(vertex) + " of " +
                                        std::to_string(vertices) + " vertices");
        }
        double ignored = 0;
        for (std::size_t i = 0; i < std::min<std::size_t>(tokens.size(), 3); ++i) {
            if (const auto reason = parseNumber(tokens[i], ignored)) {
                return badLine(path, lines.number(), *reason);
            }
        }
        if (tokens.size() != 3) {
            return badLine(path, lines.number(), "a vertex has 3 coordinates");
        }
    }
    return countFaces(path, lines, vertices, faces);
}

} // namespace voxtact::io
