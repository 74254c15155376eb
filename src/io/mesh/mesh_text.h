// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace voxtact::io {

/// The lines of a text in memory, without line ends: those of Unix, of Windows, or a carriage return alone.
class TextLines {
  public:
    explicit TextLines(std::string_view content) : rest_(content) {}

    [[nodiscard]] bool next(std::string_view& line);
    [[nodiscard]] std::uint64_t number() const noexcept { return number_; }
    /// Returns the rest after the last line of next().
    [[nodiscard]] std::string_view rest() const noexcept { return rest_; }

  private:
    std::string_view rest_;
    std::uint64_t number_ = 0;
};

/// Returns the text without its byte order mark; refuses text that is not ASCII or UTF-8.
[[nodiscard]] Result<std::string_view> meshText(const std::filesystem::path& path, std::string_view content);

/// The natural number that the whole token spells.
[[nodiscard]] std::optional<std::uint64_t> parseNatural(std::string_view token);

} // namespace voxtact::io
