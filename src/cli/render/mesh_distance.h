// SPDX-License-Identifier: MIT
#pragma once

#include "cli/render/annotation.h"
#include "cli/render/shown_pairs.h"
#include "voxtact/distance.h"

#include <vector>

/// Pictures of the distance of meshes from the opaque region.
namespace voxtact::app {

/// Default distance of the last colour, mm.
inline constexpr double kDefaultShownDistance = 20;

/// Distances of each mesh at each pose, mesh by mesh.
struct MeshDistances {
    double maximum = kDefaultShownDistance;   ///< mm, of the colours
    std::vector<std::vector<Colour>> colours; ///< of the vertices: by the distance of each vertex
    std::vector<PairDistance> pairs;          ///< of the whole mesh, with witness points
};

/// Returns the mesh with vertices dense enough for such colours.
[[nodiscard]] MeshData meshForDistances(MeshData mesh, std::span<const Mat4> poses, double maximum);

/// Measures all meshes on the host.
[[nodiscard]] Result<MeshDistances> measureMeshes(const ShownPairs& pairs, double maximum, bool progress);

/// Returns the legend of the colours: 0 to `maximum`.
[[nodiscard]] Legend distanceLegend(double maximum);

/// Draws the segment between the witness points of each pair, with its length.
void drawClosest(Picture& picture, const MeshDistances& distances, const Mat4& clip_from_world);

} // namespace voxtact::app
