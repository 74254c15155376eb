// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/certified_scenes.h"

#include <vector>

namespace voxtact::test {

struct DenormalScene {
    const char* name;
    CertifiedCase scene;
    bool decided; ///< the opaque values are computed in double: what only they depend on is known
};

/// Pairs that touch for certain, but only where floats below 1.2e-38 are not taken for zero: their voxels, vertices,
/// scale or threshold are that small.
[[nodiscard]] std::vector<DenormalScene> denormalScenes();

/// The vertices of object space at `scale` voxels an object unit; a triangle in the opaque half of the volume.
[[nodiscard]] CertifiedCase scaledTriangle(double scale);

} // namespace voxtact::test
