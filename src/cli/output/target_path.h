// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <filesystem>
#include <span>
#include <string>

/// `{target}` in the path of files that each target has.
namespace voxtact::app {

/// Returns the path with `{target}` replaced by the target's name; characters that a file name cannot have become
/// underscores.
[[nodiscard]] std::filesystem::path targetPath(const std::filesystem::path& path, const std::string& target);

/// Refuses one file for several targets: a path without `{target}`, and names that map to one path. `option`: for
/// messages.
[[nodiscard]] Result<void> checkTargetPaths(const std::string& option, const std::filesystem::path& path,
                                            std::span<const std::string> targets);

} // namespace voxtact::app
