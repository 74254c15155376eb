// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/result.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace voxtact::io {

/// Reads a mesh file strictly, without keeping anything, and returns the number of triangles that it states (a polygon
/// of n corners is n-2). assimp leaves out what it does not understand without a word, reads cut-off files as far as
/// they go, and trusts indices; so a file is counted first, what is malformed is refused with its place, and what
/// assimp delivers is compared with the count.
[[nodiscard]] Result<std::uint64_t> statedTriangles(const std::filesystem::path& path);

[[nodiscard]] Result<std::uint64_t> statedByStl(const std::filesystem::path& path, std::string_view content);
[[nodiscard]] Result<std::uint64_t> statedByObj(const std::filesystem::path& path, std::string_view content);
[[nodiscard]] Result<std::uint64_t> statedByPly(const std::filesystem::path& path, std::string_view content);
[[nodiscard]] Result<std::uint64_t> statedByOff(const std::filesystem::path& path, std::string_view content);
[[nodiscard]] Result<std::uint64_t> statedByGltf(const std::filesystem::path& path, std::string_view content);

/// The lines of a text in memory, without line ends.
class TextLines {
  public:
    explicit TextLines(std::string_view content) : rest_(content) {}

    [[nodiscard]] bool next(std::string_view& line);
    [[nodiscard]] std::uint64_t number() const noexcept { return number_; }
    [[nodiscard]] std::string_view rest() const noexcept { return rest_; }

  private:
    std::string_view rest_;
    std::uint64_t number_ = 0;
};

/// Refuses text that is not in ASCII or UTF-8.
[[nodiscard]] Result<void> checkEncoding(const std::filesystem::path& path, std::string_view content);

} // namespace voxtact::io
