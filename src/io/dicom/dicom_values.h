// SPDX-License-Identifier: MIT
#pragma once

#include "io/dicom/dicom_slice.h"
#include "io/volume/stored_image.h"
#include "voxtact/io.h"

#include <string>
#include <vector>

namespace voxtact::io {

/// The narrowest type that holds whatever the slices can say once they are rescaled: integers where all slopes and
/// intercepts are, else floats.
[[nodiscard]] StoredType dicomType(const std::vector<DicomImage>& images, const std::vector<DicomSlice>& slices);

/// What the user is told about the rescaling; empty where there is nothing to tell.
[[nodiscard]] std::string rescaleNote(const std::vector<DicomSlice>& slices, StoredType type);

/// Decodes all files into the stack, rescaled.
[[nodiscard]] Result<std::vector<std::byte>> dicomVoxels(const std::vector<DicomFile>& files,
                                                         const std::vector<DicomImage>& images,
                                                         const std::vector<DicomSlice>& slices, StoredType type,
                                                         const ReadProgress& progress);

} // namespace voxtact::io
