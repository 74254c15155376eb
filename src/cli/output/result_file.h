// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/io.h"

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>

namespace voxtact::app {

/// An io::OutputFile, or standard output.
class ResultFile {
  public:
    /// "-": standard output, written immediately.
    [[nodiscard]] static Result<ResultFile> create(const std::filesystem::path& path);
    ResultFile(ResultFile&&) noexcept;
    ResultFile& operator=(ResultFile&&) noexcept;
    ~ResultFile();

    /// Like io::OutputFile::stream().
    [[nodiscard]] std::ostream& stream() noexcept;
    [[nodiscard]] Result<void> close();
    /// Returns the file for OutputFile::commitAll(), after close(); null: standard output.
    [[nodiscard]] io::OutputFile* file() noexcept { return file_ ? &*file_ : nullptr; }

  private:
    class Standard;

    ResultFile() noexcept;

    std::optional<io::OutputFile> file_;
    std::unique_ptr<Standard> standard_; ///< standard output, instead of a file
};

} // namespace voxtact::app
