// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/document/document.h"

#include <filesystem>
#include <string>
#include <vector>

namespace voxtact::view {

/// A source of a document that is not where the document says.
struct MissingFile {
    std::string name; ///< "volume", "mesh" or of several "mesh 1", "label map" or "label names"
    std::string path; ///< where it should be, or a file of the same name beside the session
};

/// Missing files of a session read from a file, or, with an empty path, from nowhere. Builtins never are.
[[nodiscard]] std::vector<MissingFile> missingFiles(Sources sources, const std::filesystem::path& session);

/// Returns the sources with other paths for the missing files.
[[nodiscard]] Sources found(Sources sources, const std::vector<MissingFile>& files);

} // namespace voxtact::view
