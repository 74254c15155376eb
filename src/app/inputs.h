// SPDX-License-Identifier: MIT
#pragma once

#include "app/shared_options.h"
#include "voxtact/data.h"

#include <string>
#include <vector>

/// What the options name, read into host memory. What a reader has to say goes to standard error as notes.
namespace voxtact::app {

/// A path, or `builtin:NAME`.
[[nodiscard]] Result<VolumeData> loadVolume(const std::string& source);
[[nodiscard]] Result<MeshData> loadMesh(const std::string& source, const MeshOptions& options);

/// The control points that the user gave; none when the default ramp is wanted.
[[nodiscard]] Result<std::vector<ControlPoint>> loadControlPoints(const TransferFunctionOptions& options);
/// The domain that the user gave; else 0..255 for uint8 and the data's range, made wider where that is one value.
[[nodiscard]] ValueRange tableDomain(const TransferFunctionOptions& options, ScalarType type, const ValueRange& data);
/// Opacity from 0 to 1 over the domain.
[[nodiscard]] std::vector<ControlPoint> defaultRamp(const ValueRange& domain);

/// The identity when there is no path.
[[nodiscard]] Result<std::vector<Mat4>> loadPoses(const std::filesystem::path& path);

} // namespace voxtact::app
