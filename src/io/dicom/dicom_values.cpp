// SPDX-License-Identifier: MIT
#include "io/dicom/dicom_values.h"

#include "core/base/infinity.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "io/dicom/dicom_pixels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace voxtact::io {

namespace {

bool isWhole(double value) {
    return value == std::floor(value);
}

template <class Integer> bool holds(double lo, double hi) {
    return lo >= static_cast<double>(std::numeric_limits<Integer>::min()) &&
           hi <= static_cast<double>(std::numeric_limits<Integer>::max());
}

/// Writes one frame, rescaled; `to` has the frame's place in the stack.
template <class Scalar>
void fill(const DicomImage& image, const DicomSlice& slice, std::span<const std::uint32_t> cells, std::byte* to) {
    auto* out = reinterpret_cast<Scalar*>(to);
    if constexpr (std::is_floating_point_v<Scalar>) {
        std::transform(cells.begin(), cells.end(), out, [&](std::uint32_t cell) {
            return static_cast<Scalar>(slice.slope * static_cast<double>(storedValue(image, cell)) + slice.intercept);
        });
    } else {
        const auto slope = static_cast<std::int64_t>(slice.slope);
        const auto intercept = static_cast<std::int64_t>(slice.intercept);
        std::transform(cells.begin(), cells.end(), out, [&](std::uint32_t cell) {
            return static_cast<Scalar>(slope * storedValue(image, cell) + intercept);
        });
    }
}

void fillAs(StoredType type, const DicomImage& image, const DicomSlice& slice, std::span<const std::uint32_t> cells,
            std::byte* to) {
    switch (type) {
    case StoredType::UInt8:
        return fill<std::uint8_t>(image, slice, cells, to);
    case StoredType::Int16:
        return fill<std::int16_t>(image, slice, cells, to);
    case StoredType::UInt16:
        return fill<std::uint16_t>(image, slice, cells, to);
    case StoredType::Int32:
        return fill<std::int32_t>(image, slice, cells, to);
    case StoredType::UInt32:
        return fill<std::uint32_t>(image, slice, cells, to);
    default:
        return fill<float>(image, slice, cells, to);
    }
}

} // namespace

StoredType dicomType(const std::vector<DicomImage>& images, const std::vector<DicomSlice>& slices) {
    double lo = kInfinity;
    double hi = -lo;
    for (const DicomSlice& slice : slices) {
        if (!isWhole(slice.slope) || !isWhole(slice.intercept)) {
            return StoredType::Float32;
        }
        const DicomImage& image = images[slice.file];
        const double range = std::exp2(image.bitsStored);
        const double least = image.isSigned ? -range / 2 : 0;
        const double a = slice.slope * least + slice.intercept;
        const double b = slice.slope * (least + range - 1) + slice.intercept;
        lo = std::min({lo, a, b});
        hi = std::max({hi, a, b});
    }
    if (holds<std::uint8_t>(lo, hi)) {
        return StoredType::UInt8;
    }
    if (holds<std::uint16_t>(lo, hi)) {
        return StoredType::UInt16;
    }
    if (holds<std::int16_t>(lo, hi)) {
        return StoredType::Int16;
    }
    if (holds<std::uint32_t>(lo, hi)) {
        return StoredType::UInt32;
    }
    return holds<std::int32_t>(lo, hi) ? StoredType::Int32 : StoredType::Float32;
}

std::string rescaleNote(const std::vector<DicomSlice>& slices, StoredType type) {
    const auto [least, most] = std::minmax_element(
        slices.begin(), slices.end(), [](const DicomSlice& a, const DicomSlice& b) { return a.slope < b.slope; });
    if (least->slope != most->slope) {
        return "RescaleSlope differs from slice to slice (" + number(least->slope) + " to " + number(most->slope) +
               "); voxels are in real units" + (type == StoredType::Float32 ? ", as floats" : "");
    }
    return type == StoredType::Float32 ? "voxels are floats: RescaleSlope, RescaleIntercept or DoseGridScaling is no "
                                         "whole number, or a large one"
                                       : "";
}

Result<std::vector<std::byte>> dicomVoxels(const std::vector<DicomFile>& files, const std::vector<DicomImage>& images,
                                           const std::vector<DicomSlice>& slices, StoredType type,
                                           const ReadProgress& progress) {
    // Position in the stack of each frame of each file.
    std::vector<std::vector<std::size_t>> places(files.size());
    for (std::size_t i = 0; i < slices.size(); ++i) {
        std::vector<std::size_t>& of = places[slices[i].file];
        of.resize(images[slices[i].file].frames);
        of[slices[i].frame] = i;
    }
    const std::size_t sliceBytes = images.front().pixels() * storedBytes(type);
    std::vector<std::byte> voxels(sliceBytes * slices.size());
    for (std::size_t file = 0; file < files.size(); ++file) {
        const Result<void> read =
            readDicomFrames(files[file], images[file], [&](std::uint32_t frame, std::span<const std::uint32_t> cells) {
                const std::size_t place = places[file][frame];
                fillAs(type, images[file], slices[place], cells, voxels.data() + place * sliceBytes);
            });
        VOXTACT_TRY(read);
        if (progress && !progress(file + 1, files.size())) {
            return Error{ErrorCode::Cancelled, 0, "reading the DICOM series was cancelled"};
        }
    }
    return voxels;
}

} // namespace voxtact::io
