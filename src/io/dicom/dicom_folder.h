// SPDX-License-Identifier: MIT
#pragma once

#include "io/volume/stored_image.h"
#include "voxtact/io.h"

#include <filesystem>
#include <string>
#include <vector>

namespace voxtact::io {

/// The one DICOM series in a folder, or that with the SeriesInstanceUID of the options, as a stack of slices in real
/// units. The files are read here, element by element, so that nothing in them is assumed, and no library is given what
/// was not checked. Other files are left alone; a DICOM file that cannot be read is refused, since it may be a slice.
/// Memory: the image and one frame.
[[nodiscard]] Result<StoredImage> readDicomFolder(const std::filesystem::path& folder, const VolumeReadOptions& options,
                                                  std::vector<std::string>& notes);

} // namespace voxtact::io
