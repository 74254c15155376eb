// SPDX-License-Identifier: MIT
#pragma once

#include "io/dicom/dicom_data_set.h"
#include "voxtact/io.h"

#include <optional>

namespace voxtact::io {

/// A segmentation (SEG) or contours (RTSTRUCT) in one DICOM file, or in the only file of a folder; none if the path is
/// anything else.
[[nodiscard]] Result<std::optional<LabelFile>> readDicomLabels(const std::filesystem::path& path,
                                                               const VolumeReadOptions& options);

/// True if that file holds contours.
[[nodiscard]] bool isRtStruct(const std::filesystem::path& path);

/// The frames of a SEG as a label map on their own grid.
[[nodiscard]] Result<LabelFile> readDicomSeg(DicomFile file);
/// The contours of an RTSTRUCT, filled on the grid of the image that they belong to.
[[nodiscard]] Result<LabelFile> readRtStruct(const DicomFile& file, const std::optional<Grid>& grid);

} // namespace voxtact::io
