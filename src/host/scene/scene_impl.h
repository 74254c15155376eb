// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/clusters.h"
#include "core/geometry/recentre.h"
#include "exact/pair_setup.h"
#include "host/scene/cluster_tree.h"
#include "host/scene/stored_image.h"
#include "voxtact/cpu.h"

#include <span>
#include <vector>

namespace voxtact::cpu {

/// Tells one object from another that is made later at the same address.
[[nodiscard]] std::uint64_t nextObjectId() noexcept;

struct VolumeImpl {
    explicit VolumeImpl(const VolumeView& data);

    /// Brings everything that is made from the image up to date, after voxels of a box (not an empty one) changed.
    void edited(const VoxelBox& box);

    std::uint64_t id = nextObjectId(); ///< another one after every edit
    Grid grid;
    ScalarType type;
    Mat4 texture_from_world;
    shader::PairGrid pairGrid;
    double storedIntercept; ///< value = stored + storedIntercept
    StoredImage image;
    BrickRanges bricks;
};

struct TransferFunctionImpl {
    std::uint64_t id = nextObjectId();
    std::vector<ControlPoint> points; ///< for the projection certified, and distances
    ValueRange domain;                ///< of the table, for the others
    std::vector<float> table;
};

/// Vertices and triangles of a cluster begin at multiples of this in MeshImpl's arrays, so that vectors of any target
/// can be loaded whole.
inline constexpr std::uint32_t kMeshAlignment = 16;

inline constexpr std::uint32_t kNoTriangle = 0xffffffffU;

/// Ranges of a cluster's vertices and triangles in MeshImpl's arrays, including padding.
struct ClusterPlace {
    std::uint32_t firstVertex = 0;
    std::uint32_t vertexCount = 0;
    std::uint32_t firstTriangle = 0;
    std::uint32_t triangleCount = 0;
};

/// The vertices of each run of triangles, each once a run. Run r is the (r % kRunsOfCluster)th of cluster
/// r / kRunsOfCluster.
struct RunVertices {
    std::vector<std::uint32_t> first;   ///< of each run, and behind the last
    std::vector<std::uint8_t> corner;   ///< vertex of the cluster
    std::vector<std::uint8_t> triangle; ///< local index of one triangle with this vertex
};

struct MeshImpl {
    /// `checked` and `from` are of the data.
    MeshImpl(const FloatMesh& data, const MeshFacts& checked, const MeshOrigin& from);

    /// The mesh's own indices, as it was made from.
    [[nodiscard]] std::vector<std::uint32_t> indices() const;
    /// Moves its vertices; `checked` and `from` belong to the new ones. If it throws, nothing changes.
    void bend(std::span<const float> positions, const MeshFacts& checked, const MeshOrigin& from);

    std::uint64_t id = nextObjectId(); ///< another one after every update
    MeshFacts facts;
    MeshOrigin origin; ///< of the floats below
    std::vector<ClusterPlace> clusters;
    std::vector<float> x, y, z;                          ///< vertices, cluster by cluster; the padding repeats the last
    std::vector<std::uint32_t> vertices;                 ///< of x, y and z: numbers in the mesh
    std::vector<std::uint8_t> corner0, corner1, corner2; ///< of triangles: vertices of the cluster; padding: all 0
    std::vector<std::uint32_t> numbers;                  ///< of triangles in the mesh; of the padding: kNoTriangle
    /// Centres and half sides of the clusters' boxes, padded to kMeshAlignment. Rounded outward.
    std::vector<float> centreX, centreY, centreZ, halfX, halfY, halfZ;
    RunVertices runVertices;
    ClusterTree tree;
};

} // namespace voxtact::cpu
