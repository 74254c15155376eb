// SPDX-License-Identifier: MIT
#pragma once

#include "cli/render/annotation.h"
#include "cli/render/shown_pairs.h"
#include "voxtact/distance.h"

#include <vector>

/// Pictures of the distance of meshes from the opaque region.
namespace voxtact::app {

/// Default distance of the last colour, mm.
inline constexpr double kDefaultShownClearance = 20;

/// Distances of each mesh at each pose, mesh by mesh.
struct MeshClearance {
    double maximum = kDefaultShownClearance;  ///< mm, of the colours
    std::vector<std::vector<Colour>> colours; ///< of the vertices: by the clearance of each, as of a point
    std::vector<PairDistance> pairs;          ///< of the whole mesh, with the closest points
};

/// The meshes with vertices as near to each other as such colours need.
[[nodiscard]] MeshData meshForClearance(MeshData mesh, std::span<const Mat4> poses, double maximum);

/// On the host, by cpu::ClearanceMeter.
[[nodiscard]] Result<MeshClearance> measureMeshes(const ShownPairs& pairs, double maximum, bool progress);

/// Returns the legend of the colours: 0 to `maximum`.
[[nodiscard]] Legend clearanceLegend(double maximum);

/// Draws the way between the closest points of each pair that has one, and how long it is.
void drawClosest(Picture& picture, const MeshClearance& clearance, const Mat4& clip_from_world);

} // namespace voxtact::app
