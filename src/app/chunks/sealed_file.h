// SPDX-License-Identifier: MIT
#pragma once

#include "app/chunks/content_hash.h"
#include "voxtact/io.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

/// Files that say of themselves whether they are whole: a first line with what they are, the content, and a seal behind
/// it with the content's length and hash.
namespace voxtact::app {

/// An io::OutputFile, or standard output; one that is `sealed` has a first line and a seal around what is written.
class ResultFile {
  public:
    /// "-": standard output, which takes what comes, part by part.
    [[nodiscard]] static Result<ResultFile> create(const std::filesystem::path& path);
    [[nodiscard]] static Result<ResultFile> createSealed(const std::filesystem::path& path,
                                                         const std::string& firstLine);
    ResultFile(ResultFile&&) noexcept;
    ResultFile& operator=(ResultFile&&) noexcept;
    ~ResultFile();

    /// As of io::OutputFile.
    [[nodiscard]] std::ostream& stream() noexcept;
    [[nodiscard]] Result<void> close();
    [[nodiscard]] Result<void> commit();
    /// For OutputFile::commitAll(), after close(); null: standard output.
    [[nodiscard]] io::OutputFile* file() noexcept { return file_ ? &*file_ : nullptr; }

  private:
    class Sealing;
    class Standard;

    ResultFile() noexcept;

    std::optional<io::OutputFile> file_;
    std::unique_ptr<Standard> standard_; ///< instead of it
    std::unique_ptr<Sealing> sealing_;   ///< nothing: not sealed
};

enum class SealState {
    Missing, ///< there is no such file
    Whole,
    Damaged, ///< it was cut or changed, or has another first line, or cannot be read
};

/// Reads all of a file, and hands out its content, part by part, where `take` is given; it may be damaged for all that.
[[nodiscard]] SealState readSealed(const std::filesystem::path& path, const std::string& firstLine,
                                   const std::function<void(std::string_view)>& take = {});

} // namespace voxtact::app
