// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/io.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace voxtact::io {

/// Returns true if the ending is .fcsv or .mrk.json.
[[nodiscard]] bool isSlicerPoints(const std::filesystem::path& path);

/// Reads 3D Slicer's points as readPoints() says.
[[nodiscard]] Result<std::vector<NamedPoint>> readSlicerPoints(const std::filesystem::path& path,
                                                               std::optional<MeshSpace> space);

} // namespace voxtact::io
