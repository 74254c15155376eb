// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/state.h"

#include <filesystem>
#include <string>

/// What is opened while the window is there: by its menu, or dropped on it.
namespace voxtact::view {

/// In small letters, with its dot.
[[nodiscard]] std::string endingOf(const std::filesystem::path& path);

/// By the ending: STL, OBJ, PLY, OFF, VTK, glTF, STEP and IGES are meshes, .txt are poses, .json is a session where it
/// says so and else a transfer function. All else is a volume, folders too. Refuses a .json that cannot be read.
[[nodiscard]] Result<FileKind> kindOfFile(const std::filesystem::path& path);

/// Poses and transfer functions are commands that undo takes back. Of a volume, a mesh or a session only the wish is
/// left in State::wanted; a session is read for it. Nothing changes where there is an error.
[[nodiscard]] Result<void> openFile(const std::filesystem::path& path, State& state);

/// Opens all that was dropped on the window since the last call, one after the other; of what cannot be opened the last
/// is complained of.
void takeDropped(State& state);

} // namespace voxtact::view
