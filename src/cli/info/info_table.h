// SPDX-License-Identifier: MIT
#pragma once

#include "cli/info/mesh_info.h"
#include "cli/info/volume_info.h"
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

/// Contents of a path: a volume or a mesh.
struct PathInfo {
    std::string path;
    std::optional<VolumeInfo> volume;
    std::optional<MeshInfo> mesh;
};

/// A row a path; columns that are about the other kind are empty.
[[nodiscard]] io::Table infoTable(const std::vector<PathInfo>& paths);
/// Writes text: one block per path, with the histogram as bars.
void writeInfoText(std::ostream& out, const std::vector<PathInfo>& paths, double threshold);

} // namespace voxtact::app
