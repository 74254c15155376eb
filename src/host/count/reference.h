// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/methods.h"

#include <cstdint>

/// The exact arithmetic (src/exact/exact.h) triangle by triangle and pixel by pixel, without culling: the reference of
/// the engine's counts, bit for bit.
namespace voxtact::cpu {

/// Data of one pair in one view.
struct ReferencePair {
    MeshView mesh;
    VolumeView volume;
    TransferFunctionDesc transferFunction;
    View view;
    Mat4 world_from_object = identity();
    double threshold = kDefaultThreshold;
    bool rangeTest = true;                    ///< false: the coordinate is clamped
    Projection projection = Projection::View; ///< or DominantAxis: the view is not examined
    std::uint32_t samplesPerVoxel = kDefaultSamplesPerVoxel;
};

struct ReferenceCounts {
    std::uint64_t covered = 0;   ///< fragments
    std::uint64_t survivors = 0; ///< of these
};

/// Expects data that checkMesh(), checkVolume() and sampleTable() accept.
[[nodiscard]] ReferenceCounts referenceCounts(const ReferencePair& pair);

} // namespace voxtact::cpu
