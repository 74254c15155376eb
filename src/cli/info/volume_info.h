// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <string>
#include <vector>

namespace voxtact::app {

struct HistogramBin {
    double lo = 0; ///< of integers, the smallest and largest value that falls in it
    double hi = 0;
    std::uint64_t voxels = 0;
};

/// Facts of a volume.
struct VolumeInfo {
    Grid grid;
    ScalarType type = ScalarType::UInt8;
    std::string towards; ///< where index x, y and z run: "RAS"
    double oblique = 0;  ///< degrees between an index axis and the world axis that it runs along, at most
    Box world;           ///< mm, LPS
    ValueRange values;
    double mean = 0;
    std::vector<HistogramBin> histogram; ///< equal parts of the range; one where all voxels are alike
    bool isResampled = false;            ///< by --resample
    double opaque = 0;                   ///< share of the voxels whose opacity reaches the threshold, 0 to 1
};

/// Letters of the patient's sides (R or L, A or P, S or I) towards which the index axes run, each world axis once: the
/// nearest, as nibabel's aff2axcodes says.
[[nodiscard]] std::string orientationLetters(const Grid& grid);

/// Expects a volume that checkVolume() accepts, with `values` for its range, and an `opacity` that sampleTable() does.
[[nodiscard]] VolumeInfo volumeInfo(const VolumeView& volume, const ValueRange& values,
                                    std::span<const ControlPoint> opacity, double threshold, bool isResampled);

} // namespace voxtact::app
