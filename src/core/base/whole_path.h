// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace voxtact {

/// A path from the root on, without "."; links stay, and so does a path with "..", which behind a link is not the
/// folder before. Where the current folder is gone, the path as it is.
[[nodiscard]] inline std::filesystem::path wholePath(const std::filesystem::path& path) {
    std::error_code failed;
    const std::filesystem::path absolute = std::filesystem::absolute(path, failed);
    const std::filesystem::path& whole = failed ? path : absolute;
    return std::ranges::find(whole, std::filesystem::path("..")) == whole.end() ? whole.lexically_normal() : whole;
}

/// Resolves links in the existing part of a path.
[[nodiscard]] inline std::filesystem::path realPath(const std::filesystem::path& path) {
    const std::filesystem::path whole = wholePath(path);
    std::error_code failed;
    const std::filesystem::path real = std::filesystem::weakly_canonical(whole, failed);
    return failed ? whole : real;
}

} // namespace voxtact
