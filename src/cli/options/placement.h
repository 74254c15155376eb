// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/shared_options.h"
#include "voxtact/data.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Placement of meshes relative to images, and options that would improve it.
namespace voxtact::app {

/// Placement of boxes along the image axes, up to rounding.
struct Placement {
    double overlap = 0;  ///< share of the mesh's box inside the image's box, 0 to 1
    double distance = 0; ///< mm between the boxes
};

/// A mesh and the options that it was read with.
struct ReadMesh {
    const std::string& source;
    const MeshOptions& options;
    Box bounds;                  ///< object space
    std::span<const Mat4> poses; ///< a sample; the pose with the largest overlap counts
    std::string posesSpace = {}; ///< lps or ras; empty: no file of poses
};

/// Returns the placement at the pose with the largest overlap, or else the smallest distance.
[[nodiscard]] Placement placementOf(const ReadMesh& mesh, const Grid& image);

/// Placement of a mesh that is read with other options.
struct OtherReading {
    std::string options; ///< "--mesh-space ras"
    double overlap = 0;
    std::string space{}; ///< lps or ras; empty: unchanged
    double scale = 1;    ///< --mesh-scale
};

/// Returns readings in another space or unit with far more overlap, the best first; never a space that contradicts the
/// file.
[[nodiscard]] std::vector<OtherReading> otherReadings(const ReadMesh& mesh, const Grid& image);

/// "93 % of its box would be inside with --mesh-space ras"
[[nodiscard]] std::string toText(const OtherReading& reading);

/// Returns the note on a mesh that none of `poses` poses brings near an image.
[[nodiscard]] std::string farNote(const ReadMesh& mesh, const std::string& volume, const Grid& image,
                                  std::uint64_t poses);

} // namespace voxtact::app
