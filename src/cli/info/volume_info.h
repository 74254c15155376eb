// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <string>
#include <vector>

namespace voxtact::app {

struct HistogramBin {
    double lo = 0; ///< integers: the smallest and largest value in the bin
    double hi = 0;
    std::uint64_t voxels = 0;
};

/// Facts of a volume.
struct VolumeInfo {
    Grid grid;
    ScalarType type = ScalarType::UInt8;
    std::string towards; ///< directions of index x, y and z: "RAS"
    double oblique = 0;  ///< maximum angle between an index axis and its world axis, degrees
    Box world;           ///< mm, LPS
    ValueRange values;
    double mean = 0;
    std::vector<HistogramBin> histogram; ///< equal bins of the range; one if all voxels are equal
    bool isResampled = false;            ///< by --resample
    double opaque = 0;                   ///< share of the voxels whose opacity reaches the threshold, 0 to 1
};

/// Returns the side of the patient (R or L, A or P, S or I) that each index axis points to, each world axis once, like
/// nibabel's aff2axcodes.
[[nodiscard]] std::string orientationLetters(const Grid& grid);

/// Expects a volume that checkVolume() accepts, with `values` for its range, and an `opacity` that sampleTable() does.
[[nodiscard]] VolumeInfo volumeInfo(const VolumeView& volume, const ValueRange& values,
                                    std::span<const ControlPoint> opacity, double threshold, bool isResampled);

} // namespace voxtact::app
