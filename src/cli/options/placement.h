// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/shared_options.h"
#include "voxtact/data.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// How meshes lie to images, and which option would bring them there.
namespace voxtact::app {

/// Of boxes along the image's axes, rounding aside.
struct Placement {
    double overlap = 0;  ///< share of the mesh's box that is in the image's, 0 to 1
    double distance = 0; ///< mm between the boxes
};

/// A mesh as it was read.
struct ReadMesh {
    const std::string& source;
    const MeshOptions& options;
    Box bounds;                  ///< object space
    std::span<const Mat4> poses; ///< some of them; an overlap is the largest of theirs
    std::string posesSpace = {}; ///< lps or ras; empty: there is no file of poses
};

/// The mesh at the pose at which it overlaps most, or is nearest.
[[nodiscard]] Placement placementOf(const ReadMesh& mesh, const Grid& image);

/// What other options would make of a mesh.
struct OtherReading {
    std::string options; ///< "--mesh-space ras"
    double overlap = 0;
    std::string space{}; ///< lps or ras; empty: as it was read
    double scale = 1;    ///< --mesh-scale
};

/// Readings in another space or unit that would overlap the image far more, the best first; none for a space that
/// contradicts the file.
[[nodiscard]] std::vector<OtherReading> otherReadings(const ReadMesh& mesh, const Grid& image);

/// "93 % of its box would be inside with --mesh-space ras"
[[nodiscard]] std::string toText(const OtherReading& reading);

/// The note of a mesh that comes near an image at none of `poses` poses.
[[nodiscard]] std::string farNote(const ReadMesh& mesh, const std::string& volume, const Grid& image,
                                  std::uint64_t poses);

} // namespace voxtact::app
