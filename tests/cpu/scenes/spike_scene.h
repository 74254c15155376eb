// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/certified_scenes.h"

namespace voxtact::test {

/// Opaque at the value of a single entry of the table, in an image whose values rise steeply along x, and a triangle
/// that crosses it.
struct SpikeScene {
    OracleScene scene;
    double value = 0; ///< the opaque one
    double place = 0; ///< where the triangle has it: world x, mm
};

/// Of int16 or uint8. `falling`: values fall along x. `turn` says which of the triangle's corners is the first.
[[nodiscard]] SpikeScene spikeScene(ScalarType type, bool falling, int turn);

} // namespace voxtact::test
