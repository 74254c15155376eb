// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/document/document.h"

#include <filesystem>
#include <string>
#include <vector>

/// Paths of the files of a document.
namespace voxtact::view {

/// A path in the sources; may be empty or a builtin.
struct SourceMember {
    std::string name; ///< "volume", "mesh" or of several "mesh 1", "label map" or "label names"
    std::string* path;
};
/// Returns all paths, valid while `sources` is unchanged.
[[nodiscard]] std::vector<SourceMember> membersOf(Sources& sources);

/// Returns true for the path of a file or folder.
[[nodiscard]] bool isFile(const std::string& path);

/// Returns the paths for a session in `folder`: relative inside the folder, else absolute. A session moved with its
/// files still finds them, and never finds other files.
[[nodiscard]] Sources seenFrom(Sources sources, const std::filesystem::path& folder);
/// The inverse: resolves relative paths from `folder`.
[[nodiscard]] Sources foundFrom(Sources sources, const std::filesystem::path& folder);

} // namespace voxtact::view
