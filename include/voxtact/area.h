// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/bounds.h"
#include "voxtact/data.h"

#include <cstdint>
#include <vector>

/// Contact area: plain types, the same for every engine.
///
/// The contact area of a pair is the area of the opaque part of the mesh's surface, in world mm^2. A point is opaque if
/// it lies in the volume's closed box and the opacity of the trilinear interpolant there reaches the threshold. The box
/// extends to the outer faces of the outermost voxels. Every triangle counts: a closed mesh is not filled, and
/// coincident triangles count twice. The area does not depend on the triangulation. A pair that certainly does not
/// touch (projection `certified`) has area 0. A touching pair may also have area 0, if only a vertex touches.
namespace voxtact {

/// Default tolerance, mm^2: maximum upper - lower.
inline constexpr double kDefaultAreaTolerance = 0.1;

/// The contact area of one pair.
struct PairArea {
    std::uint32_t pair = 0; ///< index of the pair in its batch
    std::uint32_t item = 0; ///< index of the BatchItem of the pair
    std::uint32_t pose = 0; ///< index of the pose in that item
    Bounds bounds;          ///< mm^2
    StopReason end{};       ///< why the search stopped
};

/// The opaque area of one pair within one label: inside the boxes around the voxel centres for which labelAt() returns
/// the label. The areas of all labels add up to the area of the pair.
struct LabelArea {
    std::uint32_t pair = 0; ///< index of the pair in its batch
    std::uint32_t item = 0; ///< index of the BatchItem of the pair
    std::uint32_t pose = 0; ///< index of the pose in that item
    std::int32_t label = 0; ///< as in LabelData::values
    Bounds bounds;          ///< mm^2
    StopReason end{};       ///< why the search stopped
};

/// The contact area of one triangle of a pair. Unlisted triangles have area 0.
struct TriangleArea {
    std::uint32_t pair = 0;     ///< index of the pair in its batch
    std::uint32_t item = 0;     ///< index of the BatchItem of the pair
    std::uint32_t pose = 0;     ///< index of the pose in that item
    std::uint32_t triangle = 0; ///< index of the triangle in the mesh
    double whole = 0;           ///< mm^2: area of the whole triangle at its pose, not a bound; may be infinite
    Bounds bounds;              ///< mm^2
};

/// The answer for a batch.
struct AreaAnswer {
    std::vector<PairArea> pairs;         ///< in the order of the batch; empty if labels were requested
    std::vector<TriangleArea> triangles; ///< if requested: triangles that may have an area, by pair, then by index
    std::vector<LabelArea> labels;       ///< by pair, then in the requested order
    double wallMilliseconds = 0;         ///< duration of the whole call
};

} // namespace voxtact
