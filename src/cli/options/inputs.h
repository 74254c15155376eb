// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/shared_options.h"
#include "voxtact/data.h"
#include "voxtact/io.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Reads the inputs of the options into host memory. Notes of the readers go to standard error.
namespace voxtact::app {

/// Reads a path, with the image that namedImage() selects, or `builtin:NAME`. Ignores the image selection in `how`.
[[nodiscard]] Result<VolumeData> loadVolume(const std::string& source, const io::VolumeReadOptions& how = {});
/// Refuses a missing volume, before the first row: volumes are read one at a time, later.
[[nodiscard]] Result<void> checkVolumesAreThere(const std::vector<std::string>& sources);
[[nodiscard]] Result<MeshData> loadMesh(const std::string& source, const MeshOptions& options);

/// Returns the control points of the options; none for the default ramp.
[[nodiscard]] Result<std::vector<ControlPoint>> loadControlPoints(const TransferFunctionOptions& options);
/// Returns the domain of the options; else 0..255 for uint8, or the range of the values, widened if it is one value.
[[nodiscard]] ValueRange tableDomain(const TransferFunctionOptions& options, ScalarType type, const ValueRange& data);
/// Returns the number of table entries for pixel projections.
[[nodiscard]] std::uint32_t tableSizeFor(const TransferFunctionOptions& options, ScalarType type);
/// Like tableDomain(), for the volume of a source; notes values outside the domain.
[[nodiscard]] ValueRange usedDomain(const TransferFunctionOptions& options, ScalarType type, const ValueRange& data,
                                    const std::string& source);
/// Returns an opacity ramp from 0 to 1 over the domain.
[[nodiscard]] std::vector<ControlPoint> defaultRamp(const ValueRange& domain);

/// Returns the grid to rasterise contours on; called only for label maps of contours.
using GridSource = std::function<Result<Grid>()>;
/// Returns the grid of a volume, without keeping the volume.
[[nodiscard]] Result<Grid> gridOfVolume(const std::string& source, bool resample);

/// Reads a label map from a path like that of a volume, but no `builtin:`.
[[nodiscard]] Result<io::LabelFile> loadLabels(const std::filesystem::path& path, const GridSource& grid);
/// Returns the path of the label names: `names`, or if empty the label map's path without .gz, with .txt.
[[nodiscard]] std::filesystem::path labelNamesPath(const std::filesystem::path& names,
                                                   const std::filesystem::path& labels);
/// Reads the names from labelNamesPath(); returns none if `names` is empty and that file is missing or unreadable.
[[nodiscard]] Result<std::map<std::int32_t, std::string>> loadLabelNames(const std::filesystem::path& names,
                                                                         const std::filesystem::path& labels);
/// Reads a label map and its names; without a file of names, uses the names in the label map.
struct NamedLabels {
    LabelData labels;
    std::map<std::int32_t, std::string> names;
};
[[nodiscard]] Result<NamedLabels> loadNamedLabels(const std::filesystem::path& labels,
                                                  const std::filesystem::path& names, const GridSource& grid);

/// Reads all of standard input.
[[nodiscard]] Result<std::vector<Mat4>> readStandardPoses(io::PoseFormat format);
/// Reads poses; without a path, returns the identity. "-": standard input.
[[nodiscard]] Result<std::vector<Mat4>> loadPoses(const ViewOptions& options);
/// Converts a point or pose from `space` to LPS: "ras" negates x and y; a pose maps points of `space`.
[[nodiscard]] Vec3 lpsFrom(const std::string& space, const Vec3& point);
[[nodiscard]] Mat4 lpsFrom(const std::string& space, const Mat4& pose);

} // namespace voxtact::app
