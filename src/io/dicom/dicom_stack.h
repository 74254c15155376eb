// SPDX-License-Identifier: MIT
#pragma once

#include "io/dicom/dicom_slice.h"

#include <filesystem>
#include <vector>

namespace voxtact::io {

/// In thousandths, for messages.
[[nodiscard]] std::string millimetres(double length);

/// Refuses slices that differ from the majority of the series in size, spacing, orientation, frame of reference or
/// rescaling. The error names the slice.
[[nodiscard]] Result<void> checkAlike(const std::vector<DicomFile>& files, const std::vector<DicomImage>& images,
                                      const std::vector<DicomSlice>& slices);

/// Sorts the slices (at least two) along their normal. Refuses two at one place.
[[nodiscard]] Result<void> sortSlices(const std::filesystem::path& folder, const std::vector<DicomFile>& files,
                                      std::vector<DicomSlice>& slices);

/// The grid that sorted slices make. Refuses gaps that are uneven, and stacks that lean (a tilted gantry), saying
/// where. Slices that lie a little sideways are noted.
[[nodiscard]] Result<Grid> stackSlices(const std::filesystem::path& folder, const DicomImage& image,
                                       const std::vector<DicomSlice>& slices, std::vector<std::string>& notes);

} // namespace voxtact::io
