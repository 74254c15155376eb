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

/// What a file is, by whatever name.
struct FileIdentity {
    dev_t device = 0;
    ino_t number = 0;

    auto operator<=>(const FileIdentity&) const = default;
};

/// "cannot look at 'PATH': REASON"
[[nodiscard]] inline Error cannotLookAt(const std::filesystem::path& path, const std::error_code& why) {
    return {ErrorCode::File, 0, "cannot look at '" + path.string() + "': " + why.message()};
}

/// What is made of a path that this process may not look at. IsNothing is for names that are only guessed: what may not
/// be examined is not read either.
enum class NoAccess { IsAnError, IsNothing };

/// What is there, behind links. Nothing where nothing is; an error where that cannot be told: who took it for nothing
/// might leave out, or overwrite, what is read.
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

/// Nothing where there is no such file.
[[nodiscard]] inline Result<std::optional<FileIdentity>> identityOf(const std::filesystem::path& path,
                                                                    NoAccess noAccess = NoAccess::IsAnError) {
    const Result<std::optional<struct stat>> status = statusOf(path, noAccess);
    VOXTACT_TRY(status);
    return *status ? std::optional(FileIdentity{(*status)->st_dev, (*status)->st_ino}) : std::optional<FileIdentity>();
}

/// Whether there is an ordinary file.
[[nodiscard]] inline Result<bool> isFile(const std::filesystem::path& path, NoAccess noAccess = NoAccess::IsAnError) {
    const Result<std::optional<struct stat>> status = statusOf(path, noAccess);
    VOXTACT_TRY(status);
    return *status && S_ISREG((*status)->st_mode);
}

} // namespace voxtact::app
