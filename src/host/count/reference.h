// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/methods.h"

#include <cstdint>

/// The exact arithmetic (src/exact/exact.h) one triangle after the other, one pixel after the other, nothing skipped:
/// what the engine's counts must be, bit for bit.
namespace voxtact::cpu {

/// One pair, as data, seen once.
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
