// SPDX-License-Identifier: MIT
#pragma once

#include "io/dicom/dicom_slice.h"

#include <cstdint>
#include <span>
#include <string_view>

/// Compressed pixels of one frame. `cells` has rows x columns entries and gets the bits of each pixel as they would
/// stand in the file uncompressed. The size in the compressed data must match the file, before anything is decoded.
/// Errors say what is wrong with it, without the file.
namespace voxtact::io {

[[nodiscard]] Result<void> decodeRle(std::string_view bytes, const DicomImage& image, std::span<std::uint32_t> cells);
[[nodiscard]] Result<void> decodeJpeg(std::string_view bytes, const DicomImage& image, std::span<std::uint32_t> cells);
[[nodiscard]] Result<void> decodeJpegLs(std::string_view bytes, const DicomImage& image,
                                        std::span<std::uint32_t> cells);
[[nodiscard]] Result<void> decodeJpeg2000(std::string_view bytes, const DicomImage& image,
                                          std::span<std::uint32_t> cells);

} // namespace voxtact::io
