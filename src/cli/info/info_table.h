// SPDX-License-Identifier: MIT
#pragma once

#include "cli/info/mesh_info.h"
#include "cli/info/volume_info.h"
#include "cli/options/placement.h"
#include "cli/output/output.h"

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace voxtact::app {

struct MeshInfo {
    MeshFacts facts;
    Closedness closedness;
    std::string hint; ///< note on an implausible size; empty: none
};

/// Placement of a mesh relative to a volume.
struct PairInfo {
    std::string volume; ///< path of the volume
    Placement placement;
    std::vector<OtherReading> others; ///< the best first
};

/// Facts of a volume or mesh file, or the placement of a mesh relative to a volume.
struct PathInfo {
    std::string path;
    std::optional<VolumeInfo> volume;
    std::optional<MeshInfo> mesh;
    std::optional<PairInfo> pair;
};

/// Returns one row per path or pair; columns of other kinds are empty.
[[nodiscard]] io::Table infoTable(const std::vector<PathInfo>& paths);
/// Writes text: one block per path, with the histogram as bars.
void writeInfoText(std::ostream& out, const std::vector<PathInfo>& paths, double threshold);

} // namespace voxtact::app
