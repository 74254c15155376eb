// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::io {

/// A text file or stream line by line, in constant memory for lines of ordinary length.
class LineReader {
  public:
    [[nodiscard]] static Result<LineReader> open(const std::filesystem::path& path);
    /// The stream must outlive the reader.
    [[nodiscard]] static LineReader over(std::istream& stream);

    /// The next line without its comment (`#`), line end and a leading byte order mark; none at the end of the file.
    /// Valid until the next call.
    [[nodiscard]] std::optional<std::string_view> next();
    [[nodiscard]] std::uint64_t lineNumber() const noexcept { return number_; }

  private:
    std::unique_ptr<std::istream> file_;
    std::istream* stream_ = nullptr;
    std::string line_;
    std::uint64_t number_ = 0;
};

/// What is between blanks and tabs.
void splitTokens(std::string_view line, std::vector<std::string_view>& tokens);

/// `value` becomes the number that the whole token spells, in every locale: an optional sign, decimal digits and
/// exponent. Otherwise the reason is returned: "'1,5' is not a number".
[[nodiscard]] std::optional<std::string> parseNumber(std::string_view token, double& value);

/// A token of a file for a message: in quotes, escaped(), its beginning where it is long.
[[nodiscard]] std::string inQuotes(std::string_view token);

[[nodiscard]] std::string_view trimmed(std::string_view text);

} // namespace voxtact::io
