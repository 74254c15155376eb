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

/// Those of a session that was read from a file, or, with an empty path, from nowhere. What is builtin is never gone.
[[nodiscard]] std::vector<MissingFile> missingFiles(Sources sources, const std::filesystem::path& session);

/// The sources with other paths for what is missing.
[[nodiscard]] Sources found(Sources sources, const std::vector<MissingFile>& files);

} // namespace voxtact::view
