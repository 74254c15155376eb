// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace voxtact::io {

/// "cannot read 'PATH': REASON"
[[nodiscard]] Error cannotRead(const std::filesystem::path& path, std::string_view reason,
                               ErrorCode code = ErrorCode::Format);
/// Returns the error of a file that was not opened, with the system's reason (File); `reason`: errno, or 0.
[[nodiscard]] Error cannotOpen(const std::filesystem::path& path, int reason);
/// Returns the error of a file that is shorter than stated (File).
[[nodiscard]] Error readingStopped(const std::filesystem::path& path);
/// "cannot write 'PATH': REASON"
[[nodiscard]] Error cannotWrite(const std::filesystem::path& path, std::string_view reason,
                                ErrorCode code = ErrorCode::File);
/// "PATH line 7: REASON"
[[nodiscard]] Error badLine(const std::filesystem::path& path, std::uint64_t line, std::string_view reason);

/// Puts a library's message on one line: line breaks and runs of blanks become one blank.
[[nodiscard]] std::string oneLine(std::string_view text);

/// Returns the message of nlohmann's JSON on one line, escaped(), without the name of the exception. Shortens a long
/// one, which quotes all text so far, in the middle.
[[nodiscard]] std::string jsonReason(std::string_view text);

/// A short text of the user's or a file's, as a message may quote it: escaped(), and after 64 bytes of it "..."
/// follows.
[[nodiscard]] std::string printable(std::string_view text);

/// Returns the length of a file. Refuses missing files, and folders, pipes, sockets and devices before opening them,
/// and files that cannot be opened.
[[nodiscard]] Result<std::uint64_t> readableFile(const std::filesystem::path& path);
/// The whole file.
[[nodiscard]] Result<std::string> readWholeFile(const std::filesystem::path& path);

/// The letters of ASCII in lower case.
[[nodiscard]] std::string lowered(std::string text);

/// The end of the file's name in lower case: ".stl"; of "a.nii.gz" it is ".nii.gz".
[[nodiscard]] std::string lowerEnding(const std::filesystem::path& path);

} // namespace voxtact::io
