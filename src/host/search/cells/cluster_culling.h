// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/infinity.h"
#include "host/search/cells/cell_piece.h"
#include "host/search/cells/volume_space.h"
#include "host/search/placed.h"
#include "host/search/sweep.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>

namespace voxtact::cpu {

/// A direction, and the minimum dot product of an opaque point with it.
struct LeastAlong {
    LeastAlong(const Direction& along, double leastOfIt)
        : normal(along.normal()), least(leastOfIt), inverse(along.inverse()) {}

    glm::dvec3 normal;
    double least;
    double inverse; ///< Direction::inverse()
};

/// Some triangles of a cluster that is not swept.
struct CullingJob {
    const PlacedCluster& triangles;
    std::uint64_t among = 0; ///< a bit for each
    double lo = 0;           ///< mm: none is nearer
    double cut = 0;          ///< mm: pruned from this distance on
    double error = 0;        ///< DistanceError::absolute
};

/// Triangles that remain after pruning.
struct RemainingTriangles {
    std::uint64_t kept = 0;
    std::uint8_t nearest = 0;     ///< of the remaining triangles
    double least = kInfinity;     ///< mm: none of these is nearer
    double leastGone = kInfinity; ///< mm: none of the others is
};

/// A box of centred voxel coordinates.
struct VoxelBox3 {
    glm::dvec3 lo{};
    glm::dvec3 hi{};
};

/// Prunes each triangle by its distance along some directions. Gives the same result on every processor, like the
/// functions below.
[[nodiscard]] RemainingTriangles cullAlong(const CullingJob& job, std::span<const LeastAlong> directions);
/// Prunes each triangle by its box, and along its direction to the middle of the other box.
[[nodiscard]] RemainingTriangles cullByBox(const CullingJob& job, const VolumeSpace& space, const VoxelBox3& box);
/// Prunes each triangle along a direction, and then along its direction to the middle of a piece.
[[nodiscard]] RemainingTriangles cullByPiece(const CullingJob& job, const VolumeSpace& space, const PieceBounds& piece,
                                             const LeastAlong& direction);

/// Inputs of the transformation of a cluster: rows aligned to kMeshAlignment, padded as in MeshImpl.
struct PlaceJob {
    const glm::dmat3& local_from_object;
    const glm::dvec3& origin;
    const glm::dmat3& voxel_from_local;
    std::array<const float*, 3> vertices{};       ///< x, y and z
    std::array<const std::uint8_t*, 3> corners{}; ///< of each triangle: numbers of vertices
    std::size_t vertexCount = 0;
    std::size_t triangleCount = 0;
};

/// Transforms vertices. `local`: rows of vertices, in the space of the volume.
void placeVertices(const PlaceJob& job, const std::array<double*, 3>& local);
/// `triangles`: the corners and boxes. After placeVertices().
void placeTriangles(const PlaceJob& job, const std::array<const double*, 3>& local, PlacedCluster& triangles);

} // namespace voxtact::cpu
