// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/document/document.h"

#include <filesystem>
#include <string>
#include <vector>

namespace voxtact::view {

/// A missing source of a document.
struct MissingFile {
    std::string name; ///< "volume", "mesh" or of several "mesh 1", "label map" or "label names"
    std::string path; ///< stored path, or a file of the same name next to the session
};

/// Returns the missing files of a session; an empty path: of a session without a file. Builtins are never missing.
[[nodiscard]] std::vector<MissingFile> missingFiles(Sources sources, const std::filesystem::path& session);

/// Returns the sources with other paths for the missing files.
[[nodiscard]] Sources found(Sources sources, const std::vector<MissingFile>& files);

} // namespace voxtact::view
