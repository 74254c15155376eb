// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/state.h"

#include <filesystem>

/// Saving by the file menu. Refuses to overwrite shown files, their sources, and existing files of another kind. Writes
/// to a temporary name, then renames.
namespace voxtact::view {

/// Checks a path before the user confirms a replacement.
[[nodiscard]] Result<void> checkSession(const std::filesystem::path& path, const State& state);
[[nodiscard]] Result<void> checkFunction(const std::filesystem::path& path, const State& state);
[[nodiscard]] Result<void> checkPose(const std::filesystem::path& path, const State& state);
[[nodiscard]] Result<void> checkPicture(const std::filesystem::path& path, const State& state);

[[nodiscard]] Result<void> saveSession(const std::filesystem::path& path, const State& state);
/// Writes the curve and the colours for --transfer-function.
[[nodiscard]] Result<void> saveFunction(const std::filesystem::path& path, const State& state);
/// Writes the chosen instrument's pose for --poses.
[[nodiscard]] Result<void> savePose(const std::filesystem::path& path, const State& state);

} // namespace voxtact::view
