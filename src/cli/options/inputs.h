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

/// A path, of a file or folder with several images one as namedImage() says, or `builtin:NAME`.
/// Which image is read is not of the options.
[[nodiscard]] Result<VolumeData> loadVolume(const std::string& source, const io::VolumeReadOptions& how = {});
/// Refuses a volume that is not there. Volumes are read one at a time: this is known before the first row is written.
[[nodiscard]] Result<void> checkVolumesAreThere(const std::vector<std::string>& sources);
[[nodiscard]] Result<MeshData> loadMesh(const std::string& source, const MeshOptions& options);

/// The control points that the user gave; none when the default ramp is wanted.
[[nodiscard]] Result<std::vector<ControlPoint>> loadControlPoints(const TransferFunctionOptions& options);
/// The domain that the user gave; else 0..255 for uint8 and the data's range, made wider where that is one value.
[[nodiscard]] ValueRange tableDomain(const TransferFunctionOptions& options, ScalarType type, const ValueRange& data);
/// Entries of the table of projections that are not certified.
[[nodiscard]] std::uint32_t tableSizeFor(const TransferFunctionOptions& options, ScalarType type);
/// Like tableDomain(), for the volume of a source; notes values outside the domain.
[[nodiscard]] ValueRange usedDomain(const TransferFunctionOptions& options, ScalarType type, const ValueRange& data,
                                    const std::string& source);
/// Opacity from 0 to 1 over the domain.
[[nodiscard]] std::vector<ControlPoint> defaultRamp(const ValueRange& domain);

/// Gives the grid of the image that contours are filled on; called only for such a label map.
using GridSource = std::function<Result<Grid>()>;
/// The grid of a volume, read for it alone.
[[nodiscard]] Result<Grid> gridOfVolume(const std::string& source, bool resample);

/// A label map, named as a volume is. No `builtin:`.
[[nodiscard]] Result<io::LabelFile> loadLabels(const std::filesystem::path& path, const GridSource& grid);
/// Returns the path of the label names: `names`, or if empty the label map's path without .gz, with .txt.
[[nodiscard]] std::filesystem::path labelNamesPath(const std::filesystem::path& names,
                                                   const std::filesystem::path& labels);
/// The names of its labels from there; none where `names` is empty and that file is not there or cannot be read.
[[nodiscard]] Result<std::map<std::int32_t, std::string>> loadLabelNames(const std::filesystem::path& names,
                                                                         const std::filesystem::path& labels);
/// A label map and its names; those of the label map if there is no file of names.
struct NamedLabels {
    LabelData labels;
    std::map<std::int32_t, std::string> names;
};
[[nodiscard]] Result<NamedLabels> loadNamedLabels(const std::filesystem::path& labels,
                                                  const std::filesystem::path& names, const GridSource& grid);

/// All that standard input holds.
[[nodiscard]] Result<std::vector<Mat4>> readStandardPoses(io::PoseFormat format);
/// The identity when there is no path; "-" is standard input.
[[nodiscard]] Result<std::vector<Mat4>> loadPoses(const ViewOptions& options);
/// A point or pose from `space` to LPS: "ras" turns x and y round; a pose takes and gives such points.
[[nodiscard]] Vec3 lpsFrom(const std::string& space, const Vec3& point);
[[nodiscard]] Mat4 lpsFrom(const std::string& space, const Mat4& pose);

} // namespace voxtact::app
