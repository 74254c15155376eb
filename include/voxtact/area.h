// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/bounds.h"
#include "voxtact/data.h"

#include <cstdint>
#include <vector>

/// How much: plain types, the same for whatever measures.
///
/// The contact area of a pair is the area in world mm^2 of those points of the mesh's surface that are opaque: of its
/// triangles, each for itself (a closed mesh is not filled, and where two triangles lie on each other both count), in
/// the volume's closed box, out to the outermost voxels' faces, where the trilinear interpolant's opacity reaches the
/// threshold. It does not depend on how the surface is cut into triangles. It is what the projection `certified`
/// decides about: where that says that a pair certainly does not touch, the area is 0. What touches may have an area of
/// 0, too: a vertex that just gets there.
namespace voxtact {

/// mm^2: how near to each other bounds are brought, where nothing else is asked for.
inline constexpr double kDefaultAreaTolerance = 0.1;

/// The contact area of one pair.
struct PairArea {
    std::uint32_t pair = 0; ///< number of the pair in its batch
    std::uint32_t item = 0; ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0; ///< number of the pose within that item
    Bounds bounds;          ///< mm^2
    StopReason end{};       ///< why they are no nearer to each other
};

/// The area of one pair in what is opaque and has a label: in the boxes around its voxels' centres, where labelAt()
/// says that label. The areas of all labels together are the pair's.
struct LabelArea {
    std::uint32_t pair = 0; ///< number of the pair in its batch
    std::uint32_t item = 0; ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0; ///< number of the pose within that item
    std::int32_t label = 0; ///< as in LabelData::values
    Bounds bounds;          ///< mm^2
    StopReason end{};       ///< why they are no nearer to each other
};

/// The contact area of one triangle of a pair. Triangles that are not listed have none.
struct TriangleArea {
    std::uint32_t pair = 0;     ///< number of the pair in its batch
    std::uint32_t item = 0;     ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0;     ///< number of the pose within that item
    std::uint32_t triangle = 0; ///< number in the mesh
    double whole = 0;           ///< mm^2: the area of all of it, at its pose, no bound; infinite where `hi` is
    Bounds bounds;              ///< mm^2
};

/// What a batch gave.
struct AreaAnswer {
    std::vector<PairArea> pairs;         ///< in the order of the batch; empty where labels were asked for
    std::vector<TriangleArea> triangles; ///< those that may have an area, by pair, then by number, if asked for
    std::vector<LabelArea> labels;       ///< by pair, then in the order that the labels were asked for
    double wallMilliseconds = 0;         ///< of the whole call
};

} // namespace voxtact
