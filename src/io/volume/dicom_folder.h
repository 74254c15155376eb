// SPDX-License-Identifier: MIT
#pragma once

#include "io/volume/stored_image.h"
#include "voxtact/error.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::io {

/// The one DICOM series in a folder, or that with the SeriesInstanceUID `wanted`, as a stack of slices in real units.
/// The files are read here, element by element, so that nothing in them is assumed, and no library is given what was
/// not checked. Other files are left alone; a DICOM file that cannot be read is refused, since it may be a slice.
/// Memory: the image and one frame.
[[nodiscard]] Result<StoredImage> readDicomFolder(const std::filesystem::path& folder, std::string_view wanted,
                                                  std::vector<std::string>& notes);

} // namespace voxtact::io
