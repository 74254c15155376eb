// SPDX-License-Identifier: MIT
#pragma once

#include "io/dicom/dicom_data_set.h"
#include "voxtact/data.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace voxtact::io {

/// Storage of a file's pixels.
struct DicomImage {
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::uint32_t frames = 1;
    bool isMultiFrame = false;  ///< it has functional groups, or says more than one frame
    unsigned bitsAllocated = 0; ///< 8, 16 or 32; 1 of a mask
    unsigned bitsStored = 0;    ///< 1 to bitsAllocated
    unsigned highBit = 0;       ///< bitsStored - 1 to bitsAllocated - 1
    bool isSigned = false;
    std::uint64_t excess = 0; ///< bytes behind the pixels, in their element

    [[nodiscard]] std::uint64_t pixels() const noexcept { return std::uint64_t{columns} * rows; }
    [[nodiscard]] std::uint64_t frameBytes() const noexcept { return pixels() * (bitsAllocated / 8); }
};

/// One frame of one file, and its position: millimetres, LPS.
struct DicomSlice {
    std::size_t file = 0;            ///< in the list that it was made from
    std::uint32_t frame = 0;         ///< from 0
    std::string name;                ///< "'b.dcm'", or "frame 2 of 'b.dcm'"
    Vec3 position{};                 ///< of the first pixel's centre
    Vec3 across{};                   ///< unit vector along a row, towards higher columns
    Vec3 down{};                     ///< unit vector along a column, at right angles to `across`
    std::array<double, 2> spacing{}; ///< along `across` and `down`
    bool isRescaled = false;
    double slope = 1;
    double intercept = 0;
    double height = 0; ///< along the normal of the stack
};

/// Returns the properties of a file's pixels. Refuses unreadable elements by name, and sizes that do not match the
/// pixels.
[[nodiscard]] Result<DicomImage> dicomImage(const DicomFile& file);

/// Like above, for a mask of one bit per pixel, as in segmentations.
[[nodiscard]] Result<DicomImage> dicomMask(const DicomFile& file);

/// Numbers with backslashes between them; none unless there are as many as wanted (0: any number), and finite.
[[nodiscard]] std::optional<std::vector<double>> dicomNumbers(std::string_view text, std::size_t wanted);

/// Returns a slice per frame. Refuses missing elements by name.
[[nodiscard]] Result<std::vector<DicomSlice>> dicomSlices(const DicomFile& file, const DicomImage& image,
                                                          std::size_t index);

} // namespace voxtact::io
