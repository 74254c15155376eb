// SPDX-License-Identifier: MIT
#pragma once

#include "io/volume/stored_image.h"
#include "voxtact/io.h"

#include <filesystem>
#include <string>
#include <vector>

namespace voxtact::io {

/// The one DICOM series in a folder, or that with the SeriesInstanceUID of the options, as a stack of slices in real
/// units. Reads the files element by element, without assumptions, and passes only checked data to libraries. Ignores
/// other files; a DICOM file that cannot be read is refused, since it may be a slice. Memory: the image and one frame.
[[nodiscard]] Result<StoredImage> readDicomFolder(const std::filesystem::path& folder, const VolumeReadOptions& options,
                                                  std::vector<std::string>& notes);

} // namespace voxtact::io
