// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <system_error>

namespace voxtact {

/// A path from the root on, without "." and ".."; links stay. Without a current folder, which may be gone, the path as
/// it is.
[[nodiscard]] inline std::filesystem::path wholePath(const std::filesystem::path& path) {
    std::error_code failed;
    const std::filesystem::path whole = std::filesystem::absolute(path, failed);
    return (failed ? path : whole).lexically_normal();
}

/// The same without links.
[[nodiscard]] inline std::filesystem::path realPath(const std::filesystem::path& path) {
    std::error_code failed;
    const std::filesystem::path real = std::filesystem::weakly_canonical(wholePath(path), failed);
    return failed ? wholePath(path) : real;
}

} // namespace voxtact
