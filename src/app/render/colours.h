// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/render.h"

#include <string>
#include <vector>

namespace voxtact::app {

/// Opacity and colours of a kind of image.
struct Look {
    std::vector<ControlPoint> opacity;
    std::vector<ColourPoint> colours;
};

/// `mr`: fractions of the way from the smallest to the largest voxel, air below. `ct`: Hounsfield units, skin
/// translucent, bone solid.
[[nodiscard]] Look lookNamed(const std::string& preset, const ValueRange& values);

/// Where there is no preset: one warm white.
[[nodiscard]] std::vector<ColourPoint> plainColours();

} // namespace voxtact::app
