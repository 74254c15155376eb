// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace voxtact {

/// A path from the root on; links stay. Without a current folder, which may be gone, the path as it is. Without "." and
/// "..", but for paths that have "..": behind a link it leads elsewhere than back.
[[nodiscard]] inline std::filesystem::path wholePath(const std::filesystem::path& path) {
    std::error_code failed;
    const std::filesystem::path absolute = std::filesystem::absolute(path, failed);
    const std::filesystem::path& whole = failed ? path : absolute;
    return std::ranges::find(whole, std::filesystem::path("..")) == whole.end() ? whole.lexically_normal() : whole;
}

/// The same without links, as far as there is something.
[[nodiscard]] inline std::filesystem::path realPath(const std::filesystem::path& path) {
    const std::filesystem::path whole = wholePath(path);
    std::error_code failed;
    const std::filesystem::path real = std::filesystem::weakly_canonical(whole, failed);
    return failed ? whole : real;
}

} // namespace voxtact
