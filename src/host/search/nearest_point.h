// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/infinity.h"
#include "host/search/cells/cell_culling.h"
#include "host/search/cells/cell_walk.h"
#include "host/search/label_part.h"
#include "host/search/mesh_place.h"
#include "host/search/opaque_part.h"

#include <glm/vec3.hpp>

/// Finds near points quickly, without a guarantee. Local coordinates (VolumeSpace).
namespace voxtact::cpu {

struct MeshPoint {
    glm::dvec3 point{};
    double distance = kInfinity;
    std::uint32_t triangle = kNoTriangle; ///< its place in the mesh's arrays
};

struct OpaquePoint {
    glm::dvec3 point{};
    double distance = kInfinity;
};

/// Scratch memory of the search for an opaque point. Contents have no meaning between calls.
struct NearMemory {
    PieceRows& rows; ///< empty, before and after
    RemainingCells& cells;
    WalkRows& walks;
};

/// About the closest point of the mesh, where there is one nearer than `within`, mm.
[[nodiscard]] MeshPoint nearestOnMesh(MeshPlace& mesh, const glm::dvec3& from, double within);
/// About the closest of the points that are certainly opaque, where there is one nearer than `within`, mm.
[[nodiscard]] OpaquePoint nearestOpaque(const OpaquePart& part, const SearchedPart& searched, const VolumeImpl& volume,
                                        const glm::dvec3& from, double within, const NearMemory& memory);

/// Like nearestOpaque(), in one brick.
[[nodiscard]] OpaquePoint nearestInBrick(const OpaquePart& part, const SearchedPart& searched, const VolumeImpl& volume,
                                         const NodePlace& brick, const glm::dvec3& from, double within,
                                         const NearMemory& memory);

/// Walks along a cell's interpolant from a point of a region until the value is certainly opaque; false if it fails.
/// `at`: the cell's coordinates from -1 to 1.
[[nodiscard]] bool goToOpaque(const OpaquePart& part, const PartCell& cell, const CellRegion& region,
                              glm::dvec3& at) noexcept;

} // namespace voxtact::cpu
