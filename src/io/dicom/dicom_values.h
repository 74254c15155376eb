// SPDX-License-Identifier: MIT
#pragma once

#include "io/dicom/dicom_slice.h"
#include "io/volume/stored_image.h"
#include "voxtact/io.h"

#include <string>
#include <vector>

namespace voxtact::io {

/// Returns the narrowest type for all rescaled values of the slices: integers if all slopes and intercepts are, else
/// floats.
[[nodiscard]] StoredType dicomType(const std::vector<DicomImage>& images, const std::vector<DicomSlice>& slices);

/// Returns the note on rescaling; empty if none.
[[nodiscard]] std::string rescaleNote(const std::vector<DicomSlice>& slices, StoredType type);

/// Decodes all files into the stack, rescaled.
[[nodiscard]] Result<std::vector<std::byte>> dicomVoxels(const std::vector<DicomFile>& files,
                                                         const std::vector<DicomImage>& images,
                                                         const std::vector<DicomSlice>& slices, StoredType type,
                                                         const ReadProgress& progress);

} // namespace voxtact::io
