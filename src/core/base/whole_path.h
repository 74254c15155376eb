// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace voxtact {

/// Returns an absolute path without ".". Keeps links and "..", which after a link is not the previous folder. Returns
/// the path unchanged if the current folder is gone.
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
