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
    std::string hint; ///< what strikes in its size; empty: nothing
};

/// Placement of a mesh relative to a volume.
struct PairInfo {
    std::string volume; ///< path of the volume
    Placement placement;
    std::vector<OtherReading> others; ///< the best first
};

/// Contents of a path, a volume or a mesh, or the placement of the mesh relative to a volume.
struct PathInfo {
    std::string path;
    std::optional<VolumeInfo> volume;
    std::optional<MeshInfo> mesh;
    std::optional<PairInfo> pair;
};

/// A row a path or pair; columns that are about the other kinds are empty.
[[nodiscard]] io::Table infoTable(const std::vector<PathInfo>& paths);
/// Writes text: one block per path, with the histogram as bars.
void writeInfoText(std::ostream& out, const std::vector<PathInfo>& paths, double threshold);

} // namespace voxtact::app
