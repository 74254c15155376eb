// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <span>

namespace voxtact::app {

/// The shown pairs, as for a detector: every mesh at every pose.
struct ShownPairs {
    const VolumeData& volume;
    std::span<const MeshData> meshes;
    std::span<const Mat4> poses;
    TransferFunctionDesc transferFunction;
    double threshold = kDefaultThreshold;
};

} // namespace voxtact::app
