// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/state.h"

#include <filesystem>
#include <string>

/// Files opened by the menu, or dropped on the window.
namespace voxtact::view {

/// In lower case, with its dot.
[[nodiscard]] std::string endingOf(const std::filesystem::path& path);

/// By the ending: STL, OBJ, PLY, OFF, VTK, glTF, STEP and IGES are meshes, .txt are poses, .json is a session where it
/// says so and else a transfer function. All others, also folders, are volumes. Refuses an unreadable .json.
[[nodiscard]] Result<FileKind> kindOfFile(const std::filesystem::path& path);

/// Opens a file. Poses and transfer functions are commands that undo reverts. Volumes, meshes and sessions are
/// requested in State::wanted; a session is read first. Errors change nothing.
[[nodiscard]] Result<void> openFile(const std::filesystem::path& path, State& state);

/// Opens the files dropped since the last call, one after the other; reports the last error.
void takeDropped(State& state);

} // namespace voxtact::view
