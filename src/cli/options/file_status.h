// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/try.h"
#include "voxtact/error.h"

#include <sys/stat.h>

#include <cerrno>
#include <compare>
#include <filesystem>
#include <optional>
#include <system_error>

namespace voxtact::app {

/// Identity of a file, independent of its name.
struct FileIdentity {
    dev_t device = 0;
    ino_t number = 0;

    auto operator<=>(const FileIdentity&) const = default;
};

/// Returns "cannot examine 'PATH': REASON".
[[nodiscard]] inline Error cannotLookAt(const std::filesystem::path& path, const std::error_code& why) {
    return {ErrorCode::File, 0, "cannot examine '" + path.string() + "': " + why.message()};
}

/// Treatment of a path without permission. IsNothing is for guessed names: a file that cannot be examined is not read
/// either.
enum class NoAccess { IsAnError, IsNothing };

/// Returns the status behind links; empty if nothing is there; an error if unknown: treating an unknown path as missing
/// might skip or overwrite an input.
[[nodiscard]] inline Result<std::optional<struct stat>> statusOf(const std::filesystem::path& path,
                                                                 NoAccess noAccess = NoAccess::IsAnError) {
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0) {
        return std::optional(status);
    }
    const int why = errno;
    if (why == ENOENT || why == ENOTDIR || why == ENAMETOOLONG || (why == EACCES && noAccess == NoAccess::IsNothing)) {
        return std::optional<struct stat>();
    }
    return cannotLookAt(path, {why, std::generic_category()});
}

/// Empty if there is no such file.
[[nodiscard]] inline Result<std::optional<FileIdentity>> identityOf(const std::filesystem::path& path,
                                                                    NoAccess noAccess = NoAccess::IsAnError) {
    const Result<std::optional<struct stat>> status = statusOf(path, noAccess);
    VOXTACT_TRY(status);
    return *status ? std::optional(FileIdentity{(*status)->st_dev, (*status)->st_ino}) : std::optional<FileIdentity>();
}

/// Returns true for a regular file.
[[nodiscard]] inline Result<bool> isFile(const std::filesystem::path& path, NoAccess noAccess = NoAccess::IsAnError) {
    const Result<std::optional<struct stat>> status = statusOf(path, noAccess);
    VOXTACT_TRY(status);
    return *status && S_ISREG((*status)->st_mode);
}

} // namespace voxtact::app
