// SPDX-License-Identifier: MIT
#pragma once

#include "io/dicom/dicom_slice.h"

#include <cstdint>
#include <functional>
#include <span>

namespace voxtact::io {

/// Gets the cells of a frame (from 0), column by column and row by row: the bits of each pixel as they stand in the
/// file, BitsAllocated of them or more.
using DicomFrameVisitor = std::function<void(std::uint32_t frame, std::span<const std::uint32_t> cells)>;

/// Decodes the frames of a file in its order. Memory: one frame.
[[nodiscard]] Result<void> readDicomFrames(const DicomFile& file, const DicomImage& image,
                                           const DicomFrameVisitor& visit);

/// The number that a cell stands for, before any rescaling.
[[nodiscard]] constexpr std::int64_t storedValue(const DicomImage& image, std::uint32_t cell) noexcept {
    const std::int64_t range = std::int64_t{1} << image.bitsStored;
    const std::int64_t bits = static_cast<std::int64_t>(cell >> (image.highBit + 1 - image.bitsStored)) & (range - 1);
    return image.isSigned && bits >= range / 2 ? bits - range : bits;
}

} // namespace voxtact::io
