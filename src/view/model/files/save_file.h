// SPDX-License-Identifier: MIT
#pragma once

#include "view/state.h"

#include <filesystem>

/// What the file menu saves. Nothing goes over a file that is shown, or was read for what is shown, nor over one that
/// is there already and is of another kind. Files get a temporary name first, and their own when they are complete.
namespace voxtact::view {

[[nodiscard]] Result<void> saveSession(const std::filesystem::path& path, const State& state);
/// The curve and the colours as --transfer-function takes them.
[[nodiscard]] Result<void> saveFunction(const std::filesystem::path& path, const State& state);
/// The chosen instrument's pose, as --poses takes it.
[[nodiscard]] Result<void> savePose(const std::filesystem::path& path, const State& state);
/// Whether a picture may be written there.
[[nodiscard]] Result<void> checkPicture(const std::filesystem::path& path, const State& state);

} // namespace voxtact::view
