// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <filesystem>
#include <span>
#include <string>

/// `{target}` in the path of a file of which there is one for each target.
namespace voxtact::app {

/// The path of a target's file: `{target}` is replaced by its name, in which what could be no part of a file's name is
/// an underscore. A path without it stays as it is.
[[nodiscard]] std::filesystem::path targetPath(const std::filesystem::path& path, const std::string& target);

/// Refuses one file for several targets: a path without `{target}`, and names that become the same. `option` is for
/// messages.
[[nodiscard]] Result<void> checkTargetPaths(const std::string& option, const std::filesystem::path& path,
                                            std::span<const std::string> targets);

} // namespace voxtact::app
