// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/render.h"

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

namespace voxtact::app {

/// Opacity and colours of a kind of image.
struct Look {
    std::vector<ControlPoint> opacity;
    std::vector<ColourPoint> colours;
};

/// Those that there are.
inline constexpr std::initializer_list<const char*> kPresets = {"mr",      "mr-skin", "mr-brain",   "ct",
                                                                "ct-bone", "ct-soft", "ct-vessels", "ct-lung"};

/// Of `mr`, fractions of the way from the smallest to the largest voxel; of `ct`, Hounsfield units.
[[nodiscard]] Look lookNamed(const std::string& preset, const ValueRange& values);
/// Whether a preset is in Hounsfield units.
[[nodiscard]] bool isHounsfield(const std::string& preset);

/// What a slice shows from black to white; nothing where that depends on the image.
[[nodiscard]] std::optional<ValueRange> windowNamed(const std::string& preset);

/// Where there is no preset: one warm white.
[[nodiscard]] std::vector<ColourPoint> plainColours();

} // namespace voxtact::app
