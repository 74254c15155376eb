// SPDX-License-Identifier: MIT
#pragma once

#include "view/state.h"

#include <filesystem>

/// What the file menu saves. None of them writes over a file that was read since the window is there, nor over one that
/// is there already and is not of its kind. To a temporary name, and renamed.
namespace voxtact::view {

[[nodiscard]] Result<void> saveSession(const std::filesystem::path& path, const State& state);
/// The curve and the colours as --transfer-function takes them.
[[nodiscard]] Result<void> saveFunction(const std::filesystem::path& path, const State& state);
/// The chosen instrument's pose, as --poses takes it.
[[nodiscard]] Result<void> savePose(const std::filesystem::path& path, const State& state);
/// Whether a picture may be written there.
[[nodiscard]] Result<void> checkPicture(const std::filesystem::path& path, const State& state);

} // namespace voxtact::view
