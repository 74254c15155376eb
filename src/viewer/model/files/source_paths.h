// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/document/document.h"

#include <filesystem>
#include <string>
#include <vector>

/// The paths of the files that a document is about.
namespace voxtact::view {

/// One of them, wherever it is; the path may be empty, or of something builtin.
struct SourceMember {
    std::string name; ///< "volume", "mesh" or of several "mesh 1", "label map" or "label names"
    std::string* path;
};
/// All of them, as long as `sources` stays as it is.
[[nodiscard]] std::vector<SourceMember> membersOf(Sources& sources);

/// Whether a path is that of a file or a folder.
[[nodiscard]] bool isFile(const std::string& path);

/// As they stand in a session in `folder`: relative where they are in it or below, else absolute. So a session that is
/// moved with its files still finds them, and no other files are taken for them.
[[nodiscard]] Sources seenFrom(Sources sources, const std::filesystem::path& folder);
/// The other way round: relative paths are from `folder` on.
[[nodiscard]] Sources foundFrom(Sources sources, const std::filesystem::path& folder);

} // namespace voxtact::view
