// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/io.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <vector>

/// Transfer functions of other programs.
namespace voxtact::io {

/// Numbers as they stand in the file: not checked to ascend, nor to be in a range.
struct OtherTransferFunction {
    std::vector<ControlPoint> opacity;
    std::vector<ColourPoint> colours; ///< between them, colours are mixed in RGB here
};

/// Returns true for a colour map of ParaView: an array of objects with RGBPoints.
[[nodiscard]] bool isParaViewMap(const nlohmann::json& root);
/// Reads such a map. Refuses several maps, one without opacity, and opacity that is not linear between its points.
[[nodiscard]] Result<OtherTransferFunction> readParaViewMap(const std::filesystem::path& path,
                                                            const nlohmann::json& root);

/// Reads a volume property of 3D Slicer (.vp): an XML element VolumeProperty with the attributes scalarOpacity,
/// gradientOpacity and colorTransfer, or nine lines of which these are the last three; each has the count of its
/// numbers first. Refuses a gradient opacity other than 1.
[[nodiscard]] Result<OtherTransferFunction> readVolumeProperty(const std::filesystem::path& path);

} // namespace voxtact::io
