// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/clusters.h"
#include "exact/certified.h"
#include "host/scene/scene_impl.h"

#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// The vertices of the last requested cluster of a pair, in voxel space.
class PlacedVertices {
    static constexpr std::uint32_t kNone = 0xffffffffU;

  public:
    /// Maximum vertices of a cluster, padding included.
    static constexpr std::size_t kMost = 3 * std::size_t{kClusterTriangles} + kMeshAlignment;

    /// Both must outlive it.
    PlacedVertices(const MeshImpl& mesh, const shader::CertifiedPair& transform) : mesh_(mesh), transform_(transform) {}

    /// Places the cluster of a run. Returns the number of the run's first triangle in the mesh's arrays.
    std::size_t begin(std::uint32_t run) {
        const std::uint32_t cluster = run / ClusterTree::kRunsOfCluster;
        if (cluster != cluster_) {
            place(mesh_.clusters[cluster]);
            cluster_ = cluster;
        }
        return firstTriangle(run);
    }
    /// Returns the index of the first triangle without transforming the run.
    [[nodiscard]] std::size_t firstTriangle(std::uint32_t run) const {
        return mesh_.clusters[run / ClusterTree::kRunsOfCluster].firstTriangle +
               run % ClusterTree::kRunsOfCluster * kRunTriangles;
    }
    /// The number of its first vertex in the mesh's arrays.
    [[nodiscard]] std::size_t firstVertex() const { return mesh_.clusters[cluster_].firstVertex; }
    [[nodiscard]] shader::CertifiedVertex at(std::size_t corner) const {
        return {{x_[corner], y_[corner], z_[corner]}, error_[corner]};
    }
    /// One vertex of a triangle, without placing its cluster.
    [[nodiscard]] shader::CertifiedVertex alone(std::uint32_t run, std::size_t triangle) const {
        return vertex(mesh_.clusters[run / ClusterTree::kRunsOfCluster].firstVertex + mesh_.corner0[triangle]);
    }

  private:
    [[nodiscard]] shader::CertifiedVertex vertex(std::size_t at) const {
        return shader::certifiedVertex(transform_, mesh_.x[at], mesh_.y[at], mesh_.z[at]);
    }
    void place(const ClusterPlace& place) {
        for (std::size_t i = 0; i < place.vertexCount; ++i) {
            const shader::CertifiedVertex placed = vertex(place.firstVertex + i);
            x_[i] = placed.point.x;
            y_[i] = placed.point.y;
            z_[i] = placed.point.z;
            error_[i] = placed.error;
        }
    }

    const MeshImpl& mesh_;
    const shader::CertifiedPair& transform_;
    std::uint32_t cluster_ = kNone;
    float x_[kMost];
    float y_[kMost];
    float z_[kMost];
    float error_[kMost];
};

} // namespace voxtact::cpu
