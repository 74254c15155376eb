// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/state.h"

#include <filesystem>

/// What the file menu saves. Nothing goes over a file that is shown, or was read for what is shown, nor over one that
/// is there already and is of another kind. Files get a temporary name first, and their own when they are complete.
namespace voxtact::view {

/// What would be refused there, before anybody is asked whether a file is to be replaced.
[[nodiscard]] Result<void> checkSession(const std::filesystem::path& path, const State& state);
[[nodiscard]] Result<void> checkFunction(const std::filesystem::path& path, const State& state);
[[nodiscard]] Result<void> checkPose(const std::filesystem::path& path, const State& state);
[[nodiscard]] Result<void> checkPicture(const std::filesystem::path& path, const State& state);

[[nodiscard]] Result<void> saveSession(const std::filesystem::path& path, const State& state);
/// The curve and the colours as --transfer-function takes them.
[[nodiscard]] Result<void> saveFunction(const std::filesystem::path& path, const State& state);
/// The chosen instrument's pose, as --poses takes it.
[[nodiscard]] Result<void> savePose(const std::filesystem::path& path, const State& state);

} // namespace voxtact::view
