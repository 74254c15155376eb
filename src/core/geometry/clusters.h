// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/recentre.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxtact {

inline constexpr std::uint32_t kClusterTriangles = 64;
/// Runs of this many triangles of a cluster, from its first on, are close together, too.
inline constexpr std::uint32_t kRunTriangles = 16;

/// Triangles that are near each other. Its triangles are consecutive in MeshClusters::triangles, its vertices in
/// MeshClusters::vertices.
struct MeshCluster {
    std::uint32_t firstTriangle = 0;
    std::uint32_t triangleCount = 0;
    std::uint32_t firstVertex = 0;
    std::uint32_t vertexCount = 0;
    std::array<float, 3> lo{}; ///< bounds of its vertices, object space
    std::array<float, 3> hi{};
};

/// A box of object space.
struct RunBox {
    std::array<float, 3> lo{};
    std::array<float, 3> hi{};
};

/// Every triangle of a mesh in exactly one cluster of at most 64.
struct MeshClusters {
    std::vector<MeshCluster> clusters;
    std::vector<std::uint32_t> triangles;             ///< numbers in the mesh, cluster by cluster
    std::vector<std::array<std::uint8_t, 3>> corners; ///< of each of `triangles`: vertices of its cluster
    std::vector<std::uint32_t> vertices;              ///< numbers in the mesh, cluster by cluster, each once a cluster
};

/// Splits at the median along the longest axis until at most kClusterTriangles are left; all clusters but the last are
/// full. The same mesh gives the same clusters. Expects a mesh that checkedMesh() returns.
[[nodiscard]] MeshClusters makeClusters(const FloatMesh& mesh);

void grow(RunBox& box, const RunBox& by);
/// Around each kRunTriangles of the triangles of `clusters`, one run after the other.
[[nodiscard]] std::vector<RunBox> runBoxes(const FloatMesh& mesh, const MeshClusters& clusters);

} // namespace voxtact
