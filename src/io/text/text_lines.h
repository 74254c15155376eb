// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::io {

/// A text file or stream line by line, in constant memory for lines of ordinary length.
class LineReader {
  public:
    [[nodiscard]] static Result<LineReader> open(const std::filesystem::path& path);
    /// The stream must outlive the reader. Its state stays as it is: the reader uses its buffer alone.
    [[nodiscard]] static LineReader over(std::istream& stream, std::filesystem::path name);

    /// The next line without its comment (`#`), line end and a leading byte order mark; none at the end of the file.
    /// Valid until the next call. Where reading fails (File), there is no line any more.
    [[nodiscard]] Result<std::optional<std::string_view>> next();
    [[nodiscard]] std::uint64_t lineNumber() const noexcept { return number_; }
    /// For messages.
    [[nodiscard]] const std::filesystem::path& name() const noexcept { return name_; }

  private:
    LineReader(std::streambuf& buffer, std::filesystem::path name);
    /// The next character; the end is one too.
    std::streambuf::int_type get();
    bool read();

    std::unique_ptr<std::filebuf> file_;
    std::streambuf* buffer_;
    std::filesystem::path name_;
    std::string line_;
    std::uint64_t number_ = 0;
    std::uint64_t left_ = 0; ///< bytes that a file says it still has
    bool stopped_ = false;   ///< in the middle of a line
};

/// Takes a line's words, which are valid until it returns, and the line's number.
using TakeWords = std::function<Result<void>(const std::vector<std::string_view>& words, std::uint64_t line)>;
/// Calls `take` for each line of a file that has words, until one is refused.
[[nodiscard]] Result<void> forWords(const std::filesystem::path& path, const TakeWords& take);

/// Returns the words between blanks and tabs.
void splitTokens(std::string_view line, std::vector<std::string_view>& tokens);

/// `value` becomes the number that the whole token spells, in every locale: an optional sign, decimal digits and
/// exponent. Otherwise the reason is returned: "'1,5' is not a number".
[[nodiscard]] std::optional<std::string> parseNumber(std::string_view token, double& value);

/// A token of a file for a message: in quotes, escaped(), its beginning where it is long.
[[nodiscard]] std::string inQuotes(std::string_view token);

[[nodiscard]] std::string_view trimmed(std::string_view text);

/// The error of a text that cannot be read: where the ending of its name is one of 3D Slicer, ParaView or HDF5, the
/// format by its name, with `use` as the way out; otherwise `error`.
[[nodiscard]] Error formatByName(const std::filesystem::path& path, Error error, std::string_view use);

} // namespace voxtact::io
